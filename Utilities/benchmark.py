"""Ratios of the medians in a Google Benchmark report: benchmark.py REPORT.json"""
import json
import re
import sys

rates = {}
for entry in json.load(open(sys.argv[1]))["benchmarks"]:
    if entry.get("aggregate_name") == "median":
        rates[re.sub("/(real_time|process_time|min_time:[0-9.]+)", "", entry["run_name"])] = entry["points"]

# What, its rate, what it is compared with, and what is aimed at.
ROWS = []
for d in ("2D", "3D"):
    plain = "Image/%s/Quality0" % d
    ROWS += [
        (plain, "PaperLoop/%s/Quality0" % d, ">= 12"),
        ("Image/%s/Quality8" % d, plain, ">= 1/5" if d == "2D" else ">= 1/8"),
        ("Image/%s/Defaults" % d, plain, ">= 1/6"),
        ("Points/%s/Quality0" % d, plain, ""),
        ("Option/%s/Isotropic" % d, plain, ""),
        ("Filter/%s/Quality0/Threads1" % d, plain, ">= 0.7 (warm)"),
        ("Filter/%s/Defaults/Threads2" % d, "Filter/%s/Defaults/Threads1" % d, ">= 1.6"),
    ]
ROWS += [
    ("Cold/2D/HugePages", "Cold/2D/Plain", ">= 1.6"),
    ("Filter/2D/Quality0/Cold", "Filter/2D/Quality0/ColdSmallPages", ">= 1.6"),
    ("Image/3D/Quality0", "Vtk/PerlinNoise", ""),
    ("Filter/2D/Defaults/Threads1", "Vtk/ImageDataLIC2D", ">= 300"),
]
print("| what | Mpoints/s | beside | Mpoints/s | ratio | aim |\n|---|---|---|---|---|---|")
for name, other, aim in ROWS:
    if name in rates and other in rates:
        print("| %s | %.1f | %s | %.2f | %.2f | %s |" % (
            name, rates[name] / 1e6, other, rates[other] / 1e6, rates[name] / rates[other], aim))
print("\n| every benchmark | Mpoints/s |\n|---|---|")
for name in sorted(rates):
    print("| %s | %.2f |" % (name, rates[name] / 1e6))
