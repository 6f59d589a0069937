#!/usr/bin/env bash
# Converts and segments freiburg1_desk once for all tests of this folder; rawlog-segment does nothing
# when its sidecar is there already.
#
#   prepare.sh FOLDER_OF_THE_PROGRAMS OUTPUT_FOLDER
set -euo pipefail
skipped=77

[ -d "${SEMLOOP_DATA:-}/data/tum_fr1_desk" ] || { echo "SEMLOOP_DATA has no data/tum_fr1_desk"; exit $skipped; }

bin=$1 out=$2
mkdir -p "$out"
"$bin/tum2rawlog" "$SEMLOOP_DATA/data/tum_fr1_desk" "$out/desk.rawlog"
"$bin/rawlog-segment" "$out/desk.rawlog" \
  --model "$SEMLOOP_DATA/models/yolo11n-seg-480x640.onnx" \
  --embedding-model "$SEMLOOP_DATA/models/mobilenetv1_imagenet_feat1024.onnx"
