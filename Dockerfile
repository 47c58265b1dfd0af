# The node `hand_detector` on ROS 2 Jazzy; docs/container.md shows how to run it.
#   docker build -t raised-hand-tracker .
#   docker build -t raised-hand-tracker --build-arg MODELS=start .   # fetch the models later

# ROS and Ubuntu packages, as package.xml names them, and an empty virtual environment. It sees
# Ubuntu's packages and keeps their numpy, for which ROS's messages are compiled.
FROM ros:jazzy AS system
SHELL ["/bin/bash", "-o", "pipefail", "-c"]
COPY package.xml /tmp/package/
RUN echo 'APT::Install-Recommends "false";' > /etc/apt/apt.conf.d/99-no-recommends \
    && apt-get update \
    && rosdep update --rosdistro jazzy \
    && rosdep install --from-paths /tmp/package --ignore-src --default-yes \
    && rm -rf /var/lib/apt/lists/* /tmp/package
ENV VIRTUAL_ENV=/opt/raised_hand/venv
ENV PATH=$VIRTUAL_ENV/bin:$PATH \
    RAISED_HAND_MODELS=/opt/raised_hand/models \
    HOME=/home/ubuntu
# The user `ubuntu` of the image has the number 1000.
RUN install -d -o ubuntu -g ubuntu /opt/raised_hand "$RAISED_HAND_MODELS"
USER 1000:1000
RUN python3 -m venv --system-site-packages "$VIRTUAL_ENV"

FROM system AS node
COPY --chown=1000:1000 . /tmp/source
# pip puts the launch file and the parameters into share/, where ROS finds them; programs it puts
# into bin/, but ROS looks for them in lib/raised_hand_tracker/.
RUN pip install --no-cache-dir "numpy==1.26.*" /tmp/source \
    && install -d "$VIRTUAL_ENV/lib/raised_hand_tracker" \
    && ln -s ../../bin/hand_detector ../../bin/lifecycle_hand_detector \
        "$VIRTUAL_ENV/lib/raised_hand_tracker/"
ENV AMENT_PREFIX_PATH=$VIRTUAL_ENV
COPY docker/entrypoint.sh /opt/raised_hand/entrypoint.sh
# build: the models become part of the image; start: they are fetched at the first start.
ARG MODELS=build
# Whoever the container runs as may add compiled code and models.
RUN if [ "$MODELS" = build ]; then raised-hand models fetch; fi \
    && install -d "$HOME/.cache" "$HOME/.ros" \
    && chmod -R a+rwX "$HOME" "$RAISED_HAND_MODELS"
WORKDIR $HOME
ENTRYPOINT ["/opt/raised_hand/entrypoint.sh"]
CMD ["ros2", "launch", "raised_hand_tracker", "hand_detector.launch.py"]
