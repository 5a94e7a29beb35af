"""The commands of the documentation as one shell script, to be run in the project's root by documented-commands.sh.

Usage: python3 documented-commands.py FILE.md... >SCRIPT

Every line of a fenced block without a language is a command and is taken as it is written; the script ends where one
fails. A python block after "save this as `NAME`" is written to the file NAME first. Left out is what SKIPPED names.
"""
import re
import sys

SKIPPED = {
    "bash Utilities/demo.sh": "a step of fresh.sh",
    "bash Utilities/test.sh": "a step of fresh.sh",
    "bash Utilities/sanitize.sh": "half an hour; CI runs it on the host",
}
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SAVE = re.compile(r"save this as `([^`]+)`:\s*$")


def script(text):
    end = 0
    for block in BLOCK.finditer(text):
        name = SAVE.search(text[end:block.start()])
        end = block.end()
        if block[1] == "python" and name:
            yield f"cat >{name[1]} <<'END'\n{block[2]}END"
        elif not block[1]:
            for line in block[2].splitlines():
                command = re.sub(r"\s+#.*", "", line).strip()
                reason = SKIPPED.get(command)
                # Not by "set -e", which does not see what fails before "&&".
                yield f"# {command}: {reason}" if reason else f"{{ {line}\n}} || exit 1"


for path in sys.argv[1:]:
    with open(path, encoding="utf-8") as file:
        print("\n".join(script(file.read())))
