#!/usr/bin/env bash
# Measures the noise of oracle runs and writes oracle_noise.txt, which their tests are held to.
#
#   tests/renderer/integrate/measure_oracle_noise.sh [RUNS [BUILD FOLDER]]
#
# RUNS is a pattern of names, '*' for all (default; a quarter of an hour of one core): 'cavity_*_sobol'.
# Other rows stay as they are. JOBS=N measures with N processes.
#
# For a change that is meant to alter the noise: say in the commit why, and look at what became
# worse (git diff). It fails, and leaves the table as it was, where a mean is not the closed form.
set -euo pipefail
here=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd)
runs=${1:-*}
build=${2:-$here/../../../build}
table=$here/oracle_noise.txt
logs=$(mktemp -d)
trap 'rm -rf "$logs" "$table.new"' EXIT
jobs=${JOBS:-1} pids=()
for ((i = 0; i < jobs; ++i)); do
    PLUMB_ORACLE_NOISE=measure GTEST_TOTAL_SHARDS=$jobs GTEST_SHARD_INDEX=$i \
        "$build/bin/renderer_integrate_image_tests" --gtest_filter="*OracleImage.*/$runs" \
        >"$logs/$i" &
    pids+=($!)
done
for ((i = 0; i < jobs; ++i)); do
    if ! wait "${pids[i]}"; then
        grep -hv '^noise \|^\[ RUN\|^\[       OK' "$logs/$i" >&2
        exit 1
    fi
done
{
    echo "# What correct estimators measure: written by measure_oracle_noise.sh, explained in"
    echo "# tests/support/oracle_noise.h. Variances are relative to the square of the mean."
    echo "# run samples variance kurtosis ceiling max/mean"
    # The new rows come first and win over the old ones of the same name.
    { sed -n 's/^noise //p' "$logs"/*; [[ ! -f $table ]] || grep -v '^#' "$table"; } |
        awk '!seen[$1]++' | LC_ALL=C sort
} >"$table.new"
mv "$table.new" "$table"
