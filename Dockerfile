# A machine of a farm: the program, the package for --cluster, and kernels that are compiled already.
#
#     docker build -t trimotion .
#     docker run --rm --read-only --tmpfs /tmp -v "$PWD:/data" trimotion \
#         animate clip.mp4 -o triangles.mp4
FROM python:3.12-slim

ENV PATH=/opt/trimotion/bin:$PATH \
    WARP_CACHE_PATH=/opt/trimotion/kernels \
    PIP_NO_CACHE_DIR=1 \
    PIP_DISABLE_PIP_VERSION_CHECK=1

COPY . /opt/source
RUN python -m venv /opt/trimotion
RUN pip install "/opt/source[dask]"
RUN python /opt/source/container/compile_kernels.py
RUN rm -rf /opt/source

WORKDIR /data
ENTRYPOINT ["trimotion"]
