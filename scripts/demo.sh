#!/usr/bin/env bash
# make demo: a TUM RGB-D folder -> rawlog -> instances -> map. Run again, it goes on where it was.
#
#   DATA       folder of the sequence (rgb.txt, depth.txt, ...)
#   MODEL      segmentation network; see doc/segmentation-networks.md
#   EMBEDDING  optional network for the objects' appearance
#   OUT        folder for everything that is made; BIN: where the programs are
set -euo pipefail

DATA=${DATA:-} MODEL=${MODEL:-} EMBEDDING=${EMBEDDING:-} OUT=${OUT:-out/demo} BIN=${BIN:-build/bin}

if [ -z "$DATA" ] && [ -d "${SEMLOOP_DATA:-}/data/tum_fr1_desk" ]; then
  DATA=$SEMLOOP_DATA/data/tum_fr1_desk
fi
if [ -z "$MODEL" ] && [ -f "${SEMLOOP_DATA:-}/models/yolo11n-seg-480x640.onnx" ]; then
  MODEL=$SEMLOOP_DATA/models/yolo11n-seg-480x640.onnx
  EMBEDDING=${EMBEDDING:-$SEMLOOP_DATA/models/mobilenetv1_imagenet_feat1024.onnx}
fi
if [ -z "$DATA" ] || [ -z "$MODEL" ]; then
  cat >&2 << 'END'
make demo DATA=<folder> MODEL=<net.onnx> needs a sequence and a segmentation network:
  DATA   unpack freiburg1_desk of the TUM RGB-D benchmark, https://cvg.cit.tum.de/data/datasets/rgbd-dataset/download
  MODEL  export a YOLO-seg network to ONNX as doc/segmentation-networks.md shows (EMBEDDING=<net.onnx> is optional)
END
  exit 1
fi

name=$(basename "$DATA")
rawlog=$OUT/$name.rawlog
result=$OUT/result
mkdir -p "$OUT"

[ -f "$rawlog" ] || "$BIN/tum2rawlog" "$DATA" "$rawlog"

embedding=()
[ -z "$EMBEDDING" ] || embedding=(--embedding-model "$EMBEDDING")
"$BIN/rawlog-segment" "$rawlog" --model "$MODEL" "${embedding[@]}"

"$BIN/semloop-slam" -c config_ini/tum_rgbd.ini -i "$rawlog" -o "$result"

truth=$OUT/${name}_groundtruth.tum
if [ -f "$truth" ]; then
  "$BIN/semloop-eval" trajectory "$result/trajectory.tum" "$truth"
fi

echo
echo "Results are in $result: trajectory.tum, objects.json, objects/*.ply, loops.jsonl, summary.json"
echo "Look at the map with: SceneViewer3D $result/scene.3Dscene"
