#!/usr/bin/env bash
# Opens a rawlog in RawLogViewer and selects the first observation, until somebody writes HOME/seen.
#
#   rawlogviewer.sh IN.rawlog PLUGIN.so HOME
set -euo pipefail

rawlog=$1 plugin=$2
# The viewer writes its settings into the home folder.
export HOME=$3
trap 'kill $(jobs -p) 2> /dev/null || true; wait' EXIT

RawLogViewer -l "$plugin" "$rawlog" > "$HOME/log" 2>&1 &
timeout 60 xdotool search --sync --onlyvisible --name 'Tip of the Day' > "$HOME/tip"
xdotool windowfocus "$(head -1 "$HOME/tip")" key Escape
timeout 60 xdotool search --sync --onlyvisible --name 'RawlogViewer - Part' > "$HOME/main"
xdotool windowsize --sync "$(head -1 "$HOME/main")" 1270 900

# The first drawing takes a while: whoever looks at the screen tells when it is enough.
for _ in $(seq 60); do
  [ ! -e "$HOME/seen" ] || exit 0
  xdotool mousemove 150 122 click 1
  sleep 1
done
echo "nobody saw what they were looking for"
exit 1
