#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Certifies a rasterizer in a job of continuous integration; action.yml and ci/gitlab.yml call it, and people may. What it does is said by
# variables: one of SUREFILL_PLUGIN, SUREFILL_COMMAND and SUREFILL_ADAPTER, and, if wanted, SUREFILL_PACKAGE (path or address of the .deb),
# SUREFILL_SHA256, SUREFILL_ARGUMENTS, SUREFILL_LEVEL (quick), SUREFILL_OPTIONS, SUREFILL_REPORT (surefill-report).
# Exit status: 0 certified, 1 not, 2 nothing could be judged.
set -euo pipefail

fail() { printf 'surefill: %s\n' "$*" >&2; exit 2; }

# ---------------------------------------------------------------- what is judged
# An empty variable is no rasterizer: a job whose variable is not set must not be green.
rasterizer=()
for name in plugin command adapter; do
  variable=SUREFILL_${name^^}
  [ -z "${!variable:-}" ] || rasterizer+=("--$name" "${!variable}")
done
[ ${#rasterizer[@]} -eq 2 ] || fail "exactly one of plugin, command and adapter is needed"
[ -z "${SUREFILL_ARGUMENTS:-}" ] || rasterizer+=(--plugin-arguments "$SUREFILL_ARGUMENTS")

# ---------------------------------------------------------------- the command
if [ -n "${SUREFILL_PACKAGE:-}" ]; then
  package=$(mktemp -d)/surefill.deb
  case $SUREFILL_PACKAGE in
    http://* | https://*) curl -fsSL -o "$package" "$SUREFILL_PACKAGE" || fail "cannot get $SUREFILL_PACKAGE" ;;
    *) cp "$SUREFILL_PACKAGE" "$package" || fail "there is no $SUREFILL_PACKAGE" ;;
  esac
  [ -z "${SUREFILL_SHA256:-}" ] || echo "$SUREFILL_SHA256  $package" | sha256sum -c --quiet - || fail "the package is another one"
  root=()
  [ "$(id -u)" = 0 ] || root=(sudo)
  "${root[@]}" apt-get update -qq
  "${root[@]}" apt-get install -y -qq --no-install-recommends "$package" >/dev/null || fail "the package does not install"
fi
command -v surefill >/dev/null || fail "the command is not on the PATH, and no package was given"

# ---------------------------------------------------------------- the run
report=${SUREFILL_REPORT:-surefill-report}
mkdir -p "$report"
read -ra options <<<"${SUREFILL_OPTIONS:-}"
status=0
surefill certify --level "${SUREFILL_LEVEL:-quick}" "${rasterizer[@]}" "${options[@]}" --json "$report/certificate.json" \
  --junit "$report/report.xml" --html "$report/report.html" --output-dir "$report" 2>"$report/progress.txt" |
  tee "$report/report.txt" || status=${PIPESTATUS[0]}
case $status in
  0) verdict="certified" ;;
  1) verdict="not certified" ;;
  *) verdict="nothing judged"; tail -n 20 "$report/progress.txt" >&2; status=2 ;;
esac

# ---------------------------------------------------------------- what the service shows
if [ -n "${GITHUB_OUTPUT:-}" ]; then echo "verdict=$verdict" >>"$GITHUB_OUTPUT"; fi
if [ -n "${GITHUB_STEP_SUMMARY:-}" ]; then
  {
    printf '## Surefill: %s\n\n`%s`, level %s, %s. ' "$verdict" "${rasterizer[1]}" "${SUREFILL_LEVEL:-quick}" "$(surefill --version | head -n 1)"
    printf 'The artifact holds `report.html`, with pictures, and a reduced scene for each finding.\n\n```text\n'
    head -n 120 "$report/report.txt"
    [ $status -ne 2 ] || tail -n 20 "$report/progress.txt"
    printf '```\n'
  } >>"$GITHUB_STEP_SUMMARY"
fi
exit "$status"
