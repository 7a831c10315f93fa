# For scripts that unpack a system's packages; to be sourced. They define skip() and the folder $work.

# The first mirror of these distributions (a pattern) among this machine's package sources; nothing if there is none.
package_mirror() {
  grep -rhoE "^(URIs: |deb (\[[^]]*\] )?)https?://[^ ]+/($1)/?( |\$)" /etc/apt/sources.list /etc/apt/sources.list.d 2>/dev/null |
    grep -oE 'https?://[^ ]+' | head -n 1 || true
}

# Sets suite and mirror to this machine's own, and sees to it that mmdebstrap is there.
find_packages() {
  suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
  mirror=$(package_mirror 'debian|ubuntu')
  [ -n "$suite" ] && [ -n "$mirror" ] || skip "no Debian mirror among this machine's package sources"
  command -v mmdebstrap >/dev/null ||
    { apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends mmdebstrap; } \
      >"$work/install.log" 2>&1 || skip "cannot install mmdebstrap"
}
