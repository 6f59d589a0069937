#!/usr/bin/env bash
# Runs a program on a display of its own, which ends with the program. In FOLDER, Xvfb_screen0 is what is
# on the screen (X window dump), display is the display's name, server the process to kill.
#
#   on_xvfb.sh FOLDER PROGRAM [ARGUMENT...]
set -euo pipefail

folder=$1
shift

# Xvfb chooses a display that is free, and says which. No test takes as long as the time limits.
mkfifo "$folder/number"
timeout 180 Xvfb -displayfd 3 -screen 0 1280x960x24 -fbdir "$folder" -nolisten tcp -terminate \
  3> "$folder/number" > /dev/null 2>&1 &
echo $! > "$folder/server"
read -r number < "$folder/number"
echo ":$number" > "$folder/display"
export DISPLAY=:$number
# In the foreground, as it would pass a signal on twice else.
exec timeout --foreground 120 "$@"
