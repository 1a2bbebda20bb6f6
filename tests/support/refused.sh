# shellcheck shell=sh
# Sourced by tests of bad input, with $out and $failed set.
# refused NAME PATTERN COMMAND...: exit code not 0 and not a signal, PATTERN in the one error line
refused() {
  name=$1 pattern=$2
  shift 2
  "$@" > "$out/$name.txt" 2>&1
  code=$?
  lines=$(grep -c 'error:' "$out/$name.txt")
  if [ $code -eq 0 ] || [ $code -ge 128 ] || [ "$lines" -lt 1 ] ||
    ! grep -qE -e "$pattern" "$out/$name.txt"; then
    echo "FAIL $name: exit $code, expected a line with: $pattern"
    sed 's/^/     | /' "$out/$name.txt" | tail -n 8
    failed=1
  else
    echo "ok   $name: $(grep -m 1 'error:' "$out/$name.txt")"
  fi
}
