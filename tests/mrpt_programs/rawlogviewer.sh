#!/usr/bin/env bash
# Opens a rawlog in RawLogViewer on a display of its own, selects the first observation, and leaves what is
# on the screen in SCREEN (X window dump). Exit code 77: a program is not installed.
#
#   rawlogviewer.sh IN.rawlog PLUGIN.so SCREEN.xwd
set -euo pipefail

rawlog=$1 plugin=$2 screen=$3
for program in RawLogViewer Xvfb xdotool; do
  command -v "$program" > /dev/null || { echo "$program is not installed"; exit 77; }
done

work=$(mktemp -d)
trap 'kill $(jobs -p) 2> /dev/null || true; wait; rm -rf "$work"' EXIT
# The viewer writes its settings into the home folder.
export HOME=$work

# Xvfb chooses a display that is free, and says which.
mkfifo "$work/display"
Xvfb -displayfd 3 -screen 0 1280x960x24 -fbdir "$work" -nolisten tcp 3> "$work/display" 2> /dev/null &
read -r number < "$work/display"
export DISPLAY=:$number

RawLogViewer -l "$plugin" "$rawlog" > "$work/log" 2>&1 &
timeout 60 xdotool search --sync --onlyvisible --name 'Tip of the Day' > "$work/tip"
xdotool windowfocus "$(head -1 "$work/tip")" key Escape
timeout 60 xdotool search --sync --onlyvisible --name 'RawlogViewer - Part' > "$work/main"
xdotool windowsize --sync "$(head -1 "$work/main")" 1270 900

# The first drawing takes a while: whoever looks at the screen tells when it is enough.
for _ in $(seq 60); do
  [ ! -e "$screen.seen" ] || exit 0
  xdotool mousemove 150 122 click 1
  sleep 1
  cp "$work/Xvfb_screen0" "$screen.new"
  mv "$screen.new" "$screen"
done
echo "nobody saw what they were looking for"
exit 1
