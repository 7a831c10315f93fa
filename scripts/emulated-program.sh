# Tries a program that an emulator runs; to be sourced. The script that does defines fail(), step() and the array flogmap: the
# command that starts the program.

# FOLDER PORT [OPTION of serve]...: a simulated walk is mapped and scored, page and live map are served on that port of the loopback.
try_program() {
  local folder=$1 port=$2
  shift 2
  "${flogmap[@]}" --version

  step "A map"
  rm -rf "$folder/walk" "$folder/out"
  "${flogmap[@]}" simulate --scene two-boxes-near --frames 24 --out "$folder/walk" >"$folder/simulate.log" || fail "simulate ends with $?"
  "${flogmap[@]}" map --source "euroc:$folder/walk" --out "$folder/out" || fail "map ends with $?"
  "${flogmap[@]}" evaluate --trajectory "$folder/out/trajectory.tum" --ground-truth "$folder/walk/groundtruth.tum" --json >"$folder/score.json"
  awk -F '[:,]' '/"ate_rmse_m"/ {found = 1; printf "path error %.1f mm\n", 1000 * $2; wrong = $2 > 0.012} END {exit wrong || !found}' \
    "$folder/score.json" || fail "the path is off: $(cat "$folder/score.json")"

  step "The server"
  "${flogmap[@]}" serve --source "euroc:$folder/walk" --listen "127.0.0.1:$port" "$@" >"$folder/serve.log" 2>&1 &
  server=$!
  trap 'kill "$server" 2>/dev/null || true' EXIT
  for _ in $(seq 180); do [ "$(emulated_rev "$port")" -gt 0 ] 2>/dev/null && break; sleep 1; done
  [ "$(emulated_rev "$port")" -gt 0 ] || { cat "$folder/serve.log" >&2; fail "the live map stays empty"; }
  curl -sf --max-time 20 "http://127.0.0.1:$port/" | grep -qi '<html' || fail "the page is not served"
  kill "$server"
  wait "$server" || fail "exit code $? after SIGTERM, wanted 0"
  trap - EXIT
}
emulated_rev() { curl -sf --max-time 20 "http://127.0.0.1:$1/api/v1/maps/live" | sed -n 's/.*"rev": *\([0-9]*\).*/\1/p'; }
