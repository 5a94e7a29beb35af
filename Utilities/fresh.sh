#!/usr/bin/env bash
# The README's promise on a machine with nothing installed: bash Utilities/fresh.sh bookworm|trixie|sid
# Makes a minimal Debian in a temporary folder, copies the tree (and ../shared if there) in, and runs the
# README's two commands as root, the first once more as a user with sudo, and then every command line of the
# documentation. Prints a line for each step, and the end of a step's log where it fails. Needs root, 10 GB
# and a quarter of an hour; downloads what a new machine would. Exit status 77: it cannot be tried on this
# machine, for the reason that it prints.
#
# FRESH_TEST_OPTIONS: options for ctest in the fresh system, such as "-R Kernel"; none: all tests.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
suite=${1:-}
needed=10 # GB

stop() {
  echo "fresh.sh: $*" >&2
  exit 1
}

# apt's own view of where Debian's packages come from on this machine: lines "URI release component".
archives() {
  apt-get indextargets --format '$(REPO_URI) $(RELEASE) $(COMPONENT)' "Created-By: Packages" "Origin: Debian"
}
main_archive() {
  archives | awk '$2 !~ /-/ {print $1; exit}'
}

# --- Inside: a mount and process namespace of its own (see the end of the file) ---------------------------

# step "what" command...: one line, with the log's end on failure. Processor time says more than time where
# others use the machine.
step() {
  local what=$1 start=$SECONDS log=$scratch/log result=ok seconds TIMEFORMAT='%U %S'
  shift
  { time "$@" >"$log" 2>&1 </dev/null; } 2>"$scratch/time" || result=FAILED
  seconds="$((SECONDS - start)) s, of the processor $(awk '{printf "%.0f", $1 + $2}' "$scratch/time") s"
  echo "$suite: $what: $result, $seconds"
  [ "$result" = ok ] || { echo "The end of its log:"; tail -n 60 "$log"; exit 1; }
}

make_system() {
  local main security components options=(--variant=minbase --include=ca-certificates) sources
  main=$(main_archive)
  security=$(archives | awk '$2 ~ /-security$/ {print $1; exit}')
  components=$(archives | awk '$2 !~ /-/ {print $3}' | sort -u | paste -sd ' ')
  sources=("deb $main $suite $components")
  # sid has no security suite.
  [ -z "$security" ] || [ "$suite" = sid ] || sources+=("deb $security $suite-security $components")
  if [ "$suite" = sid ]; then
    options+=(--aptopt='Acquire::Check-Valid-Until "false"')
  else
    options+=(--aptopt='Acquire::Check-Valid-Until "true"')
  fi
  # Proxies and the like.
  while read -r option; do
    options+=(--aptopt="$option")
  done < <(apt-config dump | grep -E '^Acquire::https?::[^ ]+ "[^"]')
  mmdebstrap "${options[@]}" "$suite" "$system" "${sources[@]}"
}

# The system's /dev is a small folder of its own, never the machine's.
mount_system() {
  local device
  mount -t proc proc "$system/proc"
  mount -t sysfs -o ro sysfs "$system/sys"
  mount -t tmpfs -o mode=755 tmpfs "$system/dev"
  mkdir "$system/dev/shm" "$system/dev/pts"
  mount -t tmpfs -o mode=1777 tmpfs "$system/dev/shm"
  mount -t devpts -o newinstance,ptmxmode=666,mode=620 devpts "$system/dev/pts"
  ln -s pts/ptmx "$system/dev/ptmx"
  for device in null:3 zero:5 full:7 random:8 urandom:9; do
    mknod -m 666 "$system/dev/${device%:*}" c 1 "${device#*:}"
  done
  mknod -m 666 "$system/dev/tty" c 5 0
  ln -s /proc/self/fd "$system/dev/fd"
  for device in 0:stdin 1:stdout 2:stderr; do
    ln -s "/proc/self/fd/${device%:*}" "$system/dev/${device#*:}"
  done
  cat /etc/resolv.conf >"$system/etc/resolv.conf"
  echo "127.0.0.1 localhost $(hostname)" >"$system/etc/hosts"
}

# in_system user command...: with nothing of this machine's environment but its proxies.
in_system() {
  local user=$1 home=/root
  shift
  [ "$user" = root ] || home=/home/$user
  env -i HOME="$home" USER="$user" TERM=dumb LANG=C.UTF-8 PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
    $(env | grep -iE '^(http|https|no)_proxy=' || true) \
    chroot --userspec="$user" "$system" sh -c 'cd "$HOME/project" && exec "$@"' sh "$@"
}

# The tree as committed or about to be, beside the shared folder where there is one.
copy_tree() {
  local home=$system$1
  mkdir -p "$home/project" &&
    (cd "$root" && git -c safe.directory="$root" ls-files -z | tar --null --files-from=- -c) |
    tar -x --no-same-owner -C "$home/project" &&
    { [ ! -d "$root/../shared" ] || cp -rL "$root/../shared" "$home/shared"; }
}

# A user who may use sudo, and finds links and one package missing as the first user of a machine would.
add_user() {
  in_system root sh -c 'apt-get install -y -qq sudo && useradd -m visitor &&
    echo "visitor ALL=(ALL) NOPASSWD: ALL" >/etc/sudoers.d/visitor &&
    find /usr/lib/python3* -path "*dist-packages*" -name "*.so" -type l -delete &&
    DEBIAN_FRONTEND=noninteractive apt-get purge -y -qq libhwy-dev' &&
    copy_tree /home/visitor &&
    in_system root chown -R visitor: /home/visitor
}

inside() {
  [ "$suite" != sid ] || echo "sid: goes on where the Release file is past its Valid-Until (signatures are checked)"
  step "minimal system" make_system
  mount_system
  copy_tree /root
  step "demo.sh as root" in_system root bash Utilities/demo.sh
  step "pictures" in_system root pvpython Utilities/check-pictures.py Data/cylinder_wake.vti output
  step "a user with sudo" add_user
  step "demo.sh as this user" in_system visitor bash Utilities/demo.sh
  step "the user's pictures" in_system visitor pvpython Utilities/check-pictures.py Data/cylinder_wake.vti output
  step "test.sh as root" in_system root bash Utilities/test.sh ${FRESH_TEST_OPTIONS:-}
  echo "$suite: $(grep -hE 'tests passed|tests failed' "$scratch/log" || echo "no summary of ctest")"
  grep -hE '\*\*\*(Skipped|Not Run)|\(Skipped\)' "$scratch/log" | sed "s/^/$suite: /" || true
  # test.sh has the tests built; what documentation says is run beside it, in the same folder.
  step "commands of the documentation" in_system root bash Utilities/documented-commands.sh
  echo "$suite: $(in_system root pvpython --version 2>&1 | tail -n 1), $(du -shx "$system" | cut -f1) in all"
}

if [ "${STEERABLENOISE_FRESH_SCRATCH:-}" ]; then
  scratch=$STEERABLENOISE_FRESH_SCRATCH
  system=$scratch/system
  inside
  exit
fi

# --- Outside: what is needed, and cleaning up -------------------------------------------------------------

case $suite in
  bookworm | trixie | sid) ;;
  *) stop "usage: bash Utilities/fresh.sh bookworm|trixie|sid" ;;
esac
cannot() {
  echo "$suite: not tried on a fresh system: $*"
  exit 77
}
free=$(($(df --output=avail -k "${TMPDIR:-/tmp}" | tail -n 1) / 1000000))
[ "$free" -ge "$needed" ] || cannot "$free GB free in ${TMPDIR:-/tmp}, $needed needed"
[ "$(id -u)" = 0 ] || cannot "only root can make a system with owners and devices of its own"
unshare --mount --pid --fork --propagation private sh -c \
  'mount -t tmpfs tmpfs /mnt && mount -t proc proc /proc && mknod /mnt/null c 1 3 && : >/mnt/null && chroot / true' \
  2>/dev/null || cannot "this machine does not allow mounts and devices in a namespace of its own"
[ "$(main_archive)" ] || apt-get update -qq >/dev/null 2>&1 || true
[ "$(main_archive)" ] || cannot "apt knows no archive of Debian on this machine"
command -v mmdebstrap >/dev/null || {
  apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mmdebstrap
} >/dev/null 2>&1 || cannot "mmdebstrap, which makes the minimal system, cannot be installed"

scratch=$(mktemp -d "${TMPDIR:-/tmp}/fresh-$suite-XXXXXX")
child=
clean() {
  # With the namespace's first process its other processes and mounts go as well.
  [ -z "$child" ] || { kill -KILL "$child" && wait "$child"; } 2>/dev/null || true
  if grep -qF " $scratch/" /proc/self/mountinfo; then
    echo "fresh.sh: something is mounted below $scratch: not removed" >&2
  else
    # Processes may need a moment to end.
    rm -rf --one-file-system "$scratch" 2>/dev/null || { sleep 2; rm -rf --one-file-system "$scratch"; }
  fi
}
trap clean EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP
/usr/lib/apt/apt-helper download-file "$(main_archive)dists/$suite/InRelease" "$scratch/InRelease" >/dev/null 2>&1 ||
  cannot "$(main_archive) cannot be reached, or has no $suite"
STEERABLENOISE_FRESH_SCRATCH=$scratch unshare --mount --pid --fork --kill-child --propagation private \
  bash "${BASH_SOURCE[0]}" "$suite" &
child=$!
wait "$child" && result=0 || result=$?
child=
exit "$result"
