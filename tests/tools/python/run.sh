#!/bin/sh
# run.sh TEST PROGRAM [ARGUMENT...]: runs one test file of the Python package with Debian's Python, or says that it
# was skipped.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=/usr/bin/python3
[ -x "$python" ] || { echo "SKIPPED: there is no $python"; exit 0; }
export PYTHONPATH="$here/../../../tools/python" PYTHONDONTWRITEBYTECODE=1 PARALLAX_PROGRAM="$2"
export PARALLAX_SOURCE="$here/../../.."
test=$1
shift 2
exec "$python" -W error::ResourceWarning "$here/$test" "$@"
