#!/usr/bin/env bash
# Makes build/arm64-sysroot, what a build for ARM (preset neon) links with, and installs the cross
# compiler and qemu-user, which runs its programs here. The ARM packages are unpacked into that folder
# only: installed beside those of this machine, some would replace them. Returns at once when all is
# there.
set -euo pipefail
cd "$(dirname "$0")/.."

tools=(g++-aarch64-linux-gnu qemu-user)
packages=(libhwy-dev libtbb-dev libqhull-dev libcli11-dev libfmt-dev nlohmann-json3-dev libpng-dev libopenexr-dev
  libzip-dev libgtest-dev librapidcheck-dev libboost-dev libstdc++-12-dev)
sysroot=build/arm64-sysroot

# install <package...>: into this machine, those that are missing.
install() {
  local package missing=() as_root=()
  for package in "$@"; do
    dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null | grep -qx installed ||
      missing+=("$package")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}"
}

# The state of a package manager for ARM that knows of no installed package.
write_state() {
  mkdir -p "$1/lists/partial" "$1/archives/partial"
  : > "$1/status"
  cat > "$1/apt.conf" << CONFIG
APT::Architecture "arm64";
APT::Architectures { "arm64"; };
APT::Install-Recommends "false";
APT::Sandbox::User "";
Dir::State "$1";
Dir::State::status "$1/status";
Dir::Cache "$1";
CONFIG
}

# Absolute links would lead out of the folder.
make_links_relative() {
  local link target
  find "$1" -type l -lname '/*' | while read -r link; do
    target=$(readlink "$link")
    ln -sfrn "$1$target" "$link"
  done
}

install "${tools[@]}"
if [ -e $sysroot/complete ]; then
  echo "setup_arm64: $sysroot is there"
  exit 0
fi
rm -rf $sysroot
mkdir -p $sysroot/usr/lib
ln -s usr/lib $sysroot/lib
state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
write_state "$state"
export APT_CONFIG=$state/apt.conf
apt-get update -q
apt-get install -y -q --download-only "${packages[@]}"
for package in "$state"/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" | tar -x -C $sysroot --keep-directory-symlink
done
make_links_relative "$PWD/$sysroot"
touch $sysroot/complete
echo "setup_arm64: made $sysroot"
