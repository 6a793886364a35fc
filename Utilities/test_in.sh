#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/test_in.sh bookworm|trixie [demo|test] [ARGUMENT...]
# As root: makes a bare Debian 12 or 13 (debootstrap), copies the sources there, and runs demo.sh in
# it, or test.sh with the arguments. The system is the folder $CDM_SYSTEMS_DIR/bookworm or
# $CDM_SYSTEMS_DIR/trixie, in build/systems if that is not set. It is kept, so a second run installs
# nothing and builds only what has changed; delete the folder to start from a bare system again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
release="${1:-}"
script="${2:-demo}"
if [[ ! "$release" =~ ^(bookworm|trixie)$ || ! "$script" =~ ^(demo|test)$ ]]; then
  sed -n '3,7s/^# //p' "$0"
  exit 2
fi
mirror="${CDM_DEBIAN_MIRROR:-http://deb.debian.org/debian}"
systems="${CDM_SYSTEMS_DIR:-build/systems}"
mkdir -p "$systems"
system="$(cd "$systems" && pwd)/$release"

# Debootstrap works in a folder of that name until it is done.
if [ ! -e "$system/etc/os-release" ] || [ -e "$system/debootstrap" ]; then
  echo "== making a bare $release in $system"
  rm -rf "$system"
  debootstrap --variant=minbase "$release" "$system" "$mirror"
fi
# The network as it is here, a proxy of apt as well.
cp /etc/resolv.conf /etc/hosts "$system/etc/"
apt-config dump | grep -i '^Acquire::[a-z]*::Proxy' >"$system/etc/apt/apt.conf.d/50proxy" || true

echo "== copying the sources"
project="$system/project"
mkdir -p "$project"
find "$project" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
  if [ -e "$file" ] || [ -L "$file" ]; then
    printf '%s\0' "$file"
  fi
done | tar --create --null --files-from=- | tar --extract --directory="$project"

unmount() {
  umount --recursive --lazy "$system/proc" "$system/dev" 2>/dev/null || true
}
trap unmount EXIT
mount --types proc proc "$system/proc"
mount --rbind /dev "$system/dev"
mount --make-rslave "$system/dev"

echo "== $script.sh in $release"
env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
  ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
  chroot "$system" bash "/project/Utilities/$script.sh" "${@:3}"
