#!/bin/bash
# Runs a command with ROS set up, as `docker run` and `docker exec` need it.
set -e
source /opt/ros/jazzy/setup.bash
# Not part of the image: fetched once, into the container or into a volume.
if ! compgen -G "$RAISED_HAND_MODELS/*.onnx" > /dev/null; then
    raised-hand models fetch
fi
exec "$@"
