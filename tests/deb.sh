#!/usr/bin/env bash
# What cpack makes of the release build is a package that a bare Debian installs and runs: deb.sh BUILD
# Without debootstrap, a root's rights or a mirror there is no bare root, and the test is skipped (77).
set -euo pipefail
skip() { echo "skipped: deb: $*"; exit 77; }
build=$(cd "$1" && pwd)
[ "$(id -u)" = 0 ] || skip "a bare root is made as root"
command -v debootstrap >/dev/null || skip "debootstrap is not installed (tools/setup --tests)"
command -v dpkg-shlibdeps >/dev/null || skip "dpkg-dev is not installed (tools/setup)"
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Codename: bookworm' | head -n 1)
[ -n "$mirror" ] || skip "apt has no mirror of Debian 12"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cpack --config "$build/CPackConfig.cmake" -B "$folder/package" >"$folder/cpack.log" || { cat "$folder/cpack.log"; exit 1; }
package=$(echo "$folder"/package/lineshaft_*.deb)
needed=$(dpkg-deb --field "$package" Depends)
echo "$(du -h "$package" | cut -f1) package, depends on: $needed"

# Only the packages that dpkg itself needs, and what the package asks for.
debootstrap --variant=minbase bookworm "$folder/root" "$mirror" >"$folder/debootstrap.log" 2>&1 ||
    skip "no bare root can be made: $(tail -n 1 "$folder/debootstrap.log")"
cp /etc/resolv.conf "$folder/root/etc/resolv.conf"
cp "$package" "$folder/root/tmp/lineshaft.deb"
cat >"$folder/root/tmp/try.sh" <<'END'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive
apt-get install -qqy --no-install-recommends /tmp/lineshaft.deb >/tmp/apt.log 2>&1 || { cat /tmp/apt.log; exit 1; }
cd /tmp
lineshaft --version
lineshaft new first --quiet
lineshaft test --strict first.yaml
lineshaft run first.yaml --trace first.csv --quiet
lineshaft serve first.yaml --http 127.0.0.1:18090 --for 0.1s >/dev/null
lineshaft check --strict /usr/share/lineshaft/programs/0*.yaml >/dev/null
lineshaft explain L0404 >/dev/null
END
chroot "$folder/root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root bash /tmp/try.sh
echo ok
