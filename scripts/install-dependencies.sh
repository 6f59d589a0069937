#!/usr/bin/env bash
# Installs what semloop needs from Debian 12's packages; says nothing when nothing is missing.
#
#   scripts/install-dependencies.sh             to build, test and run semloop
#   scripts/install-dependencies.sh PACKAGE...  only these packages (make format: clang-format)
set -euo pipefail

packages=(
  # building
  cmake ninja-build g++ ccache pkg-config
  # libraries
  libmrpt-dev libeigen3-dev libopencv-dev libopencv-contrib-dev libpcl-dev libceres-dev
  libopenni2-dev libspectra-dev libnanoflann-dev nlohmann-json3-dev zlib1g-dev libexpat1-dev libx11-dev
  # simulation
  libembree-dev libtinyobjloader-dev libzip-dev sweethome3d-furniture
  # tests and benchmarks
  libgtest-dev libgmock-dev libbenchmark-dev mrpt-common xvfb xauth xdotool xz-utils libgl1-mesa-dri
  # MRPT's programs, to look at rawlogs and scenes; the demo's table
  mrpt-apps python3
)
[ $# -eq 0 ] || packages=("$@")

if ! command -v dpkg-query > /dev/null; then
  echo "install-dependencies.sh: this is not Debian; install what Debian calls ${packages[*]}" >&2
  exit 1
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${Status}' "$package" 2> /dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo > /dev/null; then
    echo "install-dependencies.sh: as root, run: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
