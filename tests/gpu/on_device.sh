#!/bin/sh
# What a machine with a GPU is to tell, within SECONDS (300). On one with nvcc and the packages of the analysis:
#     tests/gpu/on_device.sh prepare     compiles, and makes the aggregates: build/gpu, which may then be carried to another machine
#     tests/gpu/on_device.sh measure     equality with the processor's code, the same bits twice, speed; lines of JSON, as they come
set -e
cd "$(dirname "$0")/../.."
python=${PYTHON:-python3}
if [ "$1" = prepare ]; then
	# threads of a block x blocks of a multiprocessor
	make build/gpu/libprocessor.so build/gpu/libprocessor-whole.so gpu build/gpu/libdevice-128x2.so build/gpu/libdevice-128x4.so build/gpu/libdevice-256x1.so build/gpu/libdevice-512x1.so
	$python tests/gpu/on_device.py prepare
else
	$python tests/gpu/on_device.py measure "${SECONDS_GIVEN:-300}"
fi
