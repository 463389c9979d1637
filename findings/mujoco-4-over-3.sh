#!/bin/sh
# `pip install --upgrade mujoco` from MuJoCo 3.17.0 to 4.0.0 says that it succeeded and leaves a package that cannot be
# imported, and pip then takes it for installed. Guess: an upgrade gives what a fresh installation gives. Cause: 4.0 is
# three wheels; pip installs mujoco-core first, then removes the files of mujoco 3, which have the same paths.
# Cure: pip uninstall -y mujoco first; what MuJoCo advises brings the newest mujoco-core beside it. Fails if it changes.
set -eu
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
python3 -m venv "$place/venv"
pip() { "$place/venv/bin/pip" "$@" -qq --disable-pip-version-check; }
pip install mujoco==3.17.0
pip install --upgrade mujoco==4.0.0 mujoco-core==4.0.0 mujoco-studio==4.0.0
echo "upgraded in place:"
if "$place/venv/bin/python" -c 'import mujoco' 2> "$place/said"; then echo "changed: it can be imported" && exit 1; fi
tail -n 1 "$place/said" | cut -c 1-90
pip install mujoco==4.0.0 && echo "installed again: pip succeeds"
if "$place/venv/bin/python" -c 'import mujoco' 2> /dev/null; then echo "changed: that mends it" && exit 1; fi
pip uninstall -y mujoco mujoco-core mujoco-studio && pip install mujoco==4.0.0 mujoco-core==4.0.0 mujoco-studio==4.0.0
"$place/venv/bin/python" -c 'import mujoco; print("uninstalled first:", mujoco.__version__)'
# Seen: upgraded in place:
#         pip install --force-reinstall --no-deps mujoco mujoco-core mujoco-studio
#       installed again: pip succeeds
#       uninstalled first: 4.0.0
