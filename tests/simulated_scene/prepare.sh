#!/usr/bin/env bash
# Runs the demo once for all tests of this folder: simulates the flat, maps it, tells the errors.
#
#   prepare.sh FOLDER_OF_THE_PROGRAMS OUTPUT_FOLDER
set -euo pipefail
skipped=77

[ -d /usr/share/sweethome3d/furniture ] || { echo "sweethome3d-furniture is not installed"; exit $skipped; }
"$1/rawlog-simulate" --help > /dev/null 2>&1 || { echo "built without simulation"; exit $skipped; }

cd "$(dirname "$0")/../.."
mkdir -p "$2"
rm -f "$2/demo.txt"
SIMULATE=1 DATA='' BIN=$1 OUT=$2 scripts/demo.sh > "$2/output.txt"
mv "$2/output.txt" "$2/demo.txt"
