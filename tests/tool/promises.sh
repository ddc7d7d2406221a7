# What the tests of the tool begin with, by `. promises.sh`: $1 the tool, $2 an empty folder, which becomes the current one.
set -u
weather=$(cd "$(dirname "$1")" && pwd)/$(basename "$1")
[ -x "$weather" ] || { echo "no tool at $1"; exit 1; }
rm -rf "$2"
mkdir -p "$2"
cd "$2" || exit 1
failed=0
complain() { echo "FAILED: $*"; failed=$((failed + 1)); }

expect() { # code name command...
    want=$1
    name=$2
    shift 2
    "$@" > "$name.log" 2>&1
    got=$?
    [ $got -eq "$want" ] || { complain "$name: exit code $got, expected $want"; cat "$name.log"; }
}
says() { grep -q -- "$2" "$1.log" || { complain "$1 does not say '$2'"; cat "$1.log"; }; }
number() { sed -n "s/^ *\"$2\": \([0-9.eE+-]*\),*$/\1/p" "$1/report.json" | head -1; }
holds() { awk "BEGIN { exit !($1) }" || complain "$2: $1"; }
plain() { sed '/"threads"/d; /"seconds"/,/}/d' "$1/report.json" > "$1.plain"; }
same() { # folders that must hold equal files, reports but for seconds and threads
    diff -r -x report.json "$1" "$2" > diff.log || { complain "$1 and $2 differ"; cat diff.log; }
    plain "$1"
    plain "$2"
    diff "$1.plain" "$2.plain" > diff.log || { complain "reports of $1 and $2 differ"; cat diff.log; }
}
