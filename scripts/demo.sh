#!/usr/bin/env bash
# make demo: simulates a flat, or takes a TUM RGB-D sequence, maps it and says how well.
#
#   DATA       folder of a sequence (rgb.txt, depth.txt, ...); without it, the one in $SEMLOOP_DATA if
#              there is a network, too, else the flat is simulated
#   MODEL      segmentation network for DATA; see doc/segmentation-networks.md
#   EMBEDDING  optional network for the objects' appearance
#   SIMULATE   1: the simulation, whatever $SEMLOOP_DATA has
#   SEED SIZE  of the simulation: furniture and noise, WxH of the images
#   OUT        folder for everything that is made; BIN: where the programs are
set -euo pipefail

DATA=${DATA:-} MODEL=${MODEL:-} EMBEDDING=${EMBEDDING:-} SIMULATE=${SIMULATE:-}
SEED=${SEED:-1} SIZE=${SIZE:-320x240} OUT=${OUT:-out/demo} BIN=${BIN:-build/bin}
scripts=$(dirname "$0")
result=$OUT/result

usage() {
  cat >&2 << 'END'
make demo DATA=<folder> MODEL=<net.onnx> needs a sequence and a segmentation network:
  DATA   unpack freiburg1_desk of the TUM RGB-D benchmark, https://cvg.cit.tum.de/data/datasets/rgbd-dataset/download
  MODEL  export a YOLO-seg network to ONNX as doc/segmentation-networks.md shows (EMBEDDING=<net.onnx> is optional)
Without DATA, make demo simulates a flat and needs nothing.
END
  exit 2
}

# A third of a camera's rate is enough for a walk, and the whole demo takes two minutes.
simulate() {
  local rate=10
  prefix=$OUT/apartment
  echo "Simulating the flat of config_ini/scenes/apartment.ini"
  "$BIN/rawlog-simulate" config_ini/scenes/apartment.ini "$prefix.rawlog" \
    --seed "$SEED" --size "$SIZE" --set camera.rate=$rate
  echo "Mapping it from noisy odometry and noisy instances"
  "$BIN/semloop-slam" -c config_ini/simulated.ini -i "$prefix.rawlog" -o "$result" \
    --set odometry.file="${prefix}_odometry.tum"
  frames_apart=$((500 * rate / 30))
}

# Run again, it goes on where it was.
sequence() {
  prefix=$OUT/$(basename "$DATA")
  [ -f "$prefix.rawlog" ] || "$BIN/tum2rawlog" "$DATA" "$prefix.rawlog"
  local embedding=()
  [ -z "$EMBEDDING" ] || embedding=(--embedding-model "$EMBEDDING")
  "$BIN/rawlog-segment" "$prefix.rawlog" --model "$MODEL" "${embedding[@]}"
  "$BIN/semloop-slam" -c config_ini/tum_rgbd.ini -i "$prefix.rawlog" -o "$result"
  frames_apart=500
}

shared=${SEMLOOP_DATA:-/dev/null}
if [ -z "$MODEL" ] && [ -f "$shared/models/yolo11n-seg-480x640.onnx" ]; then
  MODEL=$shared/models/yolo11n-seg-480x640.onnx
  appearance=$shared/models/mobilenetv1_imagenet_feat1024.onnx
  [ -n "$EMBEDDING" ] || [ ! -f "$appearance" ] || EMBEDDING=$appearance
fi
if [ -n "$SIMULATE" ] && [ "$SIMULATE" != 0 ]; then
  DATA=''
elif [ -z "$DATA" ] && [ -n "$MODEL" ] && [ -d "$shared/data/tum_fr1_desk" ]; then
  DATA=$shared/data/tum_fr1_desk
fi

mkdir -p "$OUT"
if [ -z "$DATA" ]; then
  simulate
elif [ -n "$MODEL" ]; then
  sequence
else
  usage
fi
"$scripts/demo_table.py" "$result" "$prefix" --bin "$BIN" --frames-apart "$frames_apart"
