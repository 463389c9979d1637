#!/bin/sh
# MAVProxy 1.8.74 cannot change the mode of a vehicle whose heartbeat names PX4 by the mode's name: its `mode` command
# passes pymavlink's whole entry, a tuple of three numbers, to `set_mode`, which takes three arguments, and packing the
# command fails before anything is sent. `long DO_SET_MODE 1 6` is sent. Fails if that changes.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
python3 -m venv "$place/venv"
"$place/venv/bin/pip" install --quiet --disable-pip-version-check MAVProxy==1.8.74 pymavlink==2.4.50 future setuptools
"$place/venv/bin/python" - <<'EOF'
import struct
from importlib.metadata import version

from pymavlink import mavutil
from pymavlink.dialects.v20 import common as mavlink

print("MAVProxy", version("MAVProxy"), "pymavlink", version("pymavlink"))
vehicle = mavutil.mavlink_connection("udpin:127.0.0.1:24999")
heartbeat = mavlink.MAVLink_heartbeat_message(mavlink.MAV_TYPE_QUADROTOR, mavlink.MAV_AUTOPILOT_PX4, 1, 0, 3, 3)
packet = heartbeat.pack(mavlink.MAVLink(None, srcSystem=1, srcComponent=1))
vehicle.post_message(mavlink.MAVLink(None).parse_buffer(packet)[0])

from MAVProxy.modules.mavproxy_mode import ModeModule

module = ModeModule.__new__(ModeModule)
ModeModule.master = vehicle  # all that the command uses of MAVProxy
sent = []
vehicle.write = sent.append
try:
    module.cmd_mode(["OFFBOARD"])
except struct.error as error:
    print("mode OFFBOARD:", error)
else:
    raise SystemExit("changed: it no longer fails")
assert sent == [], sent
vehicle.set_mode("OFFBOARD")  # of pymavlink itself, by the name
print("set_mode('OFFBOARD') of pymavlink: sent", len(sent), "packet(s)")
EOF
# Seen: MAVProxy 1.8.74 pymavlink 2.4.50
#       mode OFFBOARD: required argument is not a float
#       set_mode('OFFBOARD') of pymavlink: sent 1 packet(s)
