# Sourced by the scripts that a newcomer runs: need_packages yes|no package...
# Installs what is missing as root or with sudo (asked for first when someone sits there), else says what to install.

need_packages() {
    allowed=$1
    shift
    missing=""
    for package in "$@"; do
        case $(dpkg-query -W -f '${Status}' "$package" 2> /dev/null) in
            "install ok installed") ;;
            *) missing="$missing $package" ;;
        esac
    done
    [ -n "$missing" ] || return 0

    command -v dpkg-query > /dev/null 2>&1 || {
        echo "not a Debian system; please install what Debian calls:$missing" >&2
        return 0
    }
    as_root=""
    if [ "$allowed" = no ]; then
        as_root=none
    elif [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo > /dev/null 2>&1; then
            as_root=none
        elif [ -t 0 ] && [ -z "${CI:-}" ]; then
            printf 'Missing packages:%s\nInstall them with sudo apt-get? [y/N] ' "$missing"
            read -r answer
            case $answer in [yY]*) as_root=sudo ;; *) as_root=none ;; esac
        elif sudo -n true 2> /dev/null; then
            as_root="sudo -n"
        else
            as_root=none
        fi
    fi
    if [ "$as_root" = none ]; then
        echo "missing packages; install them with:" >&2
        echo "  apt-get install --no-install-recommends$missing" >&2
        return 1
    fi
    echo "installing:$missing"
    export DEBIAN_FRONTEND=noninteractive
    # shellcheck disable=SC2086
    $as_root apt-get update -q > /dev/null && $as_root apt-get install -y -q --no-install-recommends $missing > /dev/null
}
