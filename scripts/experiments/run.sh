#!/usr/bin/env bash
# make experiments: the paper's experiments on simulated scenes; writes tables and plots to doc/results and
# fails when the results do not hold what bounds.py asks for. Run again, it does only what is missing or
# was made with other programs.
#
#   SEEDS      of the simulation (1,2,3,4,5; 1,2,3 for the association)
#   JOBS       runs at a time
#   QUICK      1: one seed and short runs, results in OUT/quick/results: to try the scripts
#   TUM MODEL  folder of a TUM RGB-D sequence and segmentation network (EMBEDDING is optional): adds
#              rows for the sequence
#   OUT        folder for the runs; BIN: where the programs are
set -euo pipefail

SEEDS=${SEEDS:-} JOBS=${JOBS:-$(nproc)} QUICK=${QUICK:-} TUM=${TUM:-} MODEL=${MODEL:-}
EMBEDDING=${EMBEDDING:-} OUT=${OUT:-out/experiments} BIN=${BIN:-build/bin}
here=$(dirname "$0")
options=(--bin "$BIN" --out "$OUT" --jobs "$JOBS")
[ -z "$SEEDS" ] || options+=(--seeds "$SEEDS")
[ -z "$QUICK" ] || [ "$QUICK" = 0 ] || options+=(--quick)

if [ -n "$TUM" ]; then
  [ -n "$MODEL" ] || { echo "make experiments TUM=<folder> needs MODEL=<net.onnx>, too" >&2; exit 2; }
  rawlog=$OUT/$(basename "$TUM").rawlog
  mkdir -p "$OUT"
  [ -f "$rawlog" ] || "$BIN/tum2rawlog" "$TUM" "$rawlog"
  embedding=()
  [ -z "$EMBEDDING" ] || embedding=(--embedding-model "$EMBEDDING")
  "$BIN/rawlog-segment" "$rawlog" --model "$MODEL" "${embedding[@]}"
  options+=(--sequence "$rawlog")
fi

for experiment in loops trajectory matching_time association bounds; do
  echo "== $experiment"
  "$here/$experiment.py" "${options[@]}"
done
