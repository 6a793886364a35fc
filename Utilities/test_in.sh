#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# bash Utilities/test_in.sh bookworm|trixie [demo|test|packages] [ARGUMENT...]
# As root: makes a bare Debian 12 or 13 (debootstrap), copies the sources there, and runs demo.sh in
# it, or test.sh with the arguments; or makes the Debian packages of what is built there, and
# installs, uses and removes them in another bare system, RELEASE-packages. The system is the folder
# $CDM_SYSTEMS_DIR/bookworm or $CDM_SYSTEMS_DIR/trixie, in build/systems if that is not set. It is
# kept, so a second run installs nothing and builds only what has changed; delete the folder to
# start from a bare system again.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
release="${1:-}"
script="${2:-demo}"
if [[ ! "$release" =~ ^(bookworm|trixie)$ || ! "$script" =~ ^(demo|test|packages)$ ]]; then
  sed -n '3,9s/^# //p' "$0"
  exit 2
fi
mirror="${CDM_DEBIAN_MIRROR:-http://deb.debian.org/debian}"
systems="${CDM_SYSTEMS_DIR:-build/systems}"
mkdir -p "$systems"
systems="$(cd "$systems" && pwd)"

# Makes the folder a bare system, unless it is one.
make_system() {
  # Debootstrap works in a folder of that name until it is done.
  if [ ! -e "$1/etc/os-release" ] || [ -e "$1/debootstrap" ]; then
    echo "== making a bare $release in $1"
    rm -rf --one-file-system "$1"
    debootstrap --variant=minbase "$release" "$1" "$mirror"
  fi
  # The network as it is here, a proxy of apt as well.
  cp /etc/resolv.conf /etc/hosts "$1/etc/"
  apt-config dump | grep -i '^Acquire::[a-z]*::Proxy' >"$1/etc/apt/apt.conf.d/50proxy" || true
}

# Runs a command in a system, with /proc and /dev while it runs.
run_in() {
  mounted="$1"
  shift
  trap unmount EXIT
  mount --types proc proc "$mounted/proc"
  mount --rbind /dev "$mounted/dev"
  mount --make-rslave "$mounted/dev"
  env --ignore-environment HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    ${http_proxy:+http_proxy="$http_proxy"} ${https_proxy:+https_proxy="$https_proxy"} \
    chroot "$mounted" "$@"
  unmount
}

unmount() {
  if [ -n "$mounted" ]; then
    umount --recursive --lazy "$mounted/proc" "$mounted/dev" 2>/dev/null || true
  fi
  mounted=
}
mounted=

system="$systems/$release"
if [ "$script" = packages ]; then
  echo "== making the packages in $release"
  run_in "$system" bash -c "cd /project/build && rm -f *.deb && cmake --build . && cpack"
  user="$systems/$release-packages"
  rm -rf --one-file-system "$user"
  make_system "$user"
  mkdir -p "$user/packages"
  cp "$system"/project/build/*.deb Testing/Package/check_debian.sh "$user/packages"
  cp -r Testing/Package/Consumer "$user/packages"
  echo "== installing them in a bare $release"
  run_in "$user" bash /packages/check_debian.sh /packages
  exit
fi

make_system "$system"
echo "== copying the sources"
project="$system/project"
mkdir -p "$project"
find "$project" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf --one-file-system {} +
git ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
  if [ -e "$file" ] || [ -L "$file" ]; then
    printf '%s\0' "$file"
  fi
done | tar --create --null --files-from=- | tar --extract --directory="$project"

echo "== $script.sh in $release"
run_in "$system" bash "/project/Utilities/$script.sh" "${@:3}"
