#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Usage: install_packages.sh LIST... | --advice
# Installs the Debian packages of the lists that are not installed yet. The first line of a list is a
# comment that says what they are for. Each other line is a package, or alternatives: "a | b" is
# satisfied by either. Does nothing if all are there.
# --advice prints what works on this system: a line that says what, and a command if there is one.
set -euo pipefail

fail() {
  echo "error: $*" >&2
  exit 1
}

# Debian's name of this system's release; that of Ubuntu's, of which Linux Mint, say, is made.
release() {
  # shellcheck source=/dev/null
  (. "${MRP_OS_RELEASE:-/etc/os-release}" && echo "${UBUNTU_CODENAME:-${VERSION_CODENAME:-}}") 2> /dev/null || true
}

# packages.ros.org has a python3-catkin-pkg that is newer than Debian's, and keeps Debian's catkin out.
is_in_conflict() {
  command -v apt-cache > /dev/null || return 1
  # Not in a pipe: grep ends at the first match, and apt-cache would fail.
  grep -qE '^(Conflicts|Breaks):(.*[ ,])?catkin([ ,(]|$)' \
    <<< "$(apt-cache show --no-all-versions python3-catkin-pkg 2> /dev/null)"
}

# Print what works on this system, and the command for it.
advice() {
  local vendor=Debian
  [ "$(release)" != jammy ] || vendor=Ubuntu
  if is_in_conflict; then
    echo "another archive's python3-catkin-pkg, such as packages.ros.org's, keeps $vendor's catkin out"
    # shellcheck disable=SC2028  # printf expands them
    echo "printf 'Package: python3-catkin-pkg*\nPin: release o=$vendor\nPin-Priority: 1001\n' |" \
      "sudo tee /etc/apt/preferences.d/catkin && sudo apt-get install --allow-downgrades python3-catkin-pkg"
    return
  fi
  case $(release) in
    bookworm | trixie | forky | jammy) printf '%s\n' "ROS 1 is in $vendor's archive" "make deps" ;;
    noble) echo "Ubuntu 24.04 has no ROS 1; install ROS One (https://ros.packages.techfak.net), or use" \
      "the container"; echo "make docker-run" ;;
    *) echo "ROS 1 is in the archives of Debian 14, 13 and 12 and of Ubuntu 22.04; elsewhere use the" \
      "container"; echo "make docker-run" ;;
  esac
}

if [ "$1" = --advice ]; then
  advice
  exit
fi

# Say what is wrong, and what works here.
fail_on_system() {
  { read -r what; read -r fix; } < <(advice)
  [ "$fix" != "make deps" ] || fix="make docker-run"  # it has just failed
  echo "error: $*; $what" >&2
  echo "fix: $fix" >&2
  exit 1
}

# A system with ROS One or ROS Noetic has what it needs there.
for distribution in one noetic; do
  [ ! -e "${MRP_OPT_ROS:-/opt/ros}/$distribution/setup.bash" ] || exit 0
done

# rootless.sh has laid them over the system, whose dpkg does not know them.
[ -z "${MRP_HAS_PACKAGES:-}" ] || exit 0

if ! command -v apt-get > /dev/null || ! command -v dpkg-query > /dev/null; then
  fail_on_system "this system has no apt-get"
fi

declare -A installed
while read -r status package; do
  [ "$status" != installed ] || installed[$package]=yes
done < <(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n')

# The lines without an installed alternative, and what the lists that have them are for.
lines=() purposes=
for list in "$@"; do
  purpose=
  while read -r line; do
    [[ $line != "# "* ]] || { purpose=${purpose:-${line#"# "}}; continue; }
    line=${line%%#*} alternatives=()
    IFS='| ' read -r -a alternatives <<< "$line"
    for package in "${alternatives[@]}"; do
      [ -z "${installed[$package]:-}" ] || continue 2
    done
    [ ${#alternatives[@]} != 0 ] || continue
    lines+=("${alternatives[*]}")
    [ -z "$purpose" ] || [[ $purposes == *"$purpose"* ]] || purposes+="${purposes:+, }$purpose"
  done < "$list"
done
[ ${#lines[@]} != 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo > /dev/null ||
    fail "installing packages needs root or sudo; missing: $(IFS=,; echo "${lines[*]// / or }")"
  as_root=(sudo)
fi

log=$(mktemp)
trap 'rm -f "$log"' EXIT
# apt-get keeps from its children the descriptor on which it says its progress, and sudo keeps all but
# the first three from apt-get: so it has one more, made here. Another apt-get, such as Ubuntu's own
# update, may hold the lock for minutes. Without an input, it leaves the lines that follow in a paste.
apt_get() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C \
    bash -c 'exec apt-get "$@" 3>&1' apt-get -o DPkg::Lock::Timeout=600 "$@" < /dev/null
}

# sudo asks for the password here, where nothing hides its question.
SUDO_PROMPT="[sudo] password for %p, to install Debian packages${purposes:+ $purposes}: " \
  "${as_root[@]}" true < /dev/null
[ ! -t 1 ] || echo -n "Fetching the lists of Debian's packages"
apt_get update -qq > "$log" 2>&1 || {
  echo "warning: apt-get update failed; going on with the package lists as they are:" >&2
  cat "$log" >&2
}
[ ! -t 1 ] || printf '\r\e[K'

declare -A archived
while read -r package; do
  archived[$package]=yes
done < <(printf '%s\n' "${lines[@]}" | xargs apt-cache show 2> /dev/null | sed -n 's/^Package: //p')
packages=()
for line in "${lines[@]}"; do
  for package in $line; do
    if [ -n "${archived[$package]:-}" ]; then
      packages+=("$package")
      continue 2
    fi
  done
  # shellcheck disable=SC2086  # these are several packages
  said=$(apt-cache show $line 2>&1 > /dev/null | grep -vE '^[NW]: |^E: No packages found' | head -n 1) || true
  fail_on_system "no package archive of this system has '${line// / or }'${said:+ (apt-cache says: $said)}"
done

packages=(install --no-install-recommends "${packages[@]}")
apt_get -y --print-uris "${packages[@]}" > "$log" 2>&1 || true  # it only says what it would do
count=$(sed -n 's/.*, \([0-9]*\) newly installed.*/\1/p' "$log")
fetch=$(sed -n 's/^Need to get \([^/]*B\)[/ ].*/\1/p' "$log")
disk=$(sed -n 's/^After this operation, \(.*B\) of .*/\1/p' "$log")
echo "Installing Debian packages${purposes:+ $purposes}: ${count:-some} of them," \
  "${fetch:-nothing} to fetch, ${disk:-nothing} on disk"

# On a terminal, what apt-get says of its progress becomes one line that moves.
progress() {
  local what of percent
  grep --line-buffered -E '^(dl|pm)status:' | while IFS=: read -r what of percent _; do
    [ "$what" = dlstatus ] && what=fetched || what=installed
    printf '\r\e[K  %3.0f %% %s: %s' "$percent" "$what" "${of:0:40}"
  done
  printf '\r\e[K'
}
install() {
  if [ -t 1 ]; then
    apt_get -y -o APT::Status-Fd=3 -o Dpkg::Use-Pty=0 "$@" 2>&1 | tee "$log" | progress
  else
    apt_get -y -o Dpkg::Use-Pty=0 "$@" > "$log" 2>&1
  fi
}
install "${packages[@]}" || {
  grep -vE '^(dl|pm)status:' "$log" | tail -n 30 >&2 || true
  ! is_in_conflict || fail_on_system "apt-get could not install the packages; its own message is above"
  fail "apt-get could not install the packages; its own message is above"
}
