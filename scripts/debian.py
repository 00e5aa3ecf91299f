# SPDX-License-Identifier: MIT
"""Fresh systems of Debian below a folder (debootstrap), for releases, and for tests of what a newcomer installs there.

Needs root, the network and debootstrap. The fresh systems and the packages that apt has fetched stay in FRAGTRACE_DEBIAN, by default
~/.cache/fragtrace/debian, outside every clone.
"""
import os
import re
import shutil
import subprocess
import urllib.request
from pathlib import Path

KEPT = Path(os.environ.get("FRAGTRACE_DEBIAN", Path.home() / ".cache/fragtrace/debian"))
RELEASES = ("bookworm", "trixie")
CERTIFICATES = "ssl/certs/ca-certificates.crt"
TOOLS = ("debootstrap", "dpkg-shlibdeps", "cpack", "unshare", "chroot")


def own_release():
    """The code name of the system that the tests run on."""
    found = re.search(r"^VERSION_CODENAME=(\w+)$", Path("/etc/os-release").read_text(), re.MULTILINE)
    return found[1] if found else ""


def mirror():
    """Returns the mirror from which this machine's apt takes Debian."""
    lists = [Path("/etc/apt/sources.list"), *Path("/etc/apt/sources.list.d").glob("*")]
    found = re.findall(r"^(?:deb|URIs:)\s(?:.*\s)?(https?://\S+/debian)/?(?:\s|$)", "\n".join(p.read_text() for p in lists if p.is_file()), re.MULTILINE)
    return found[0] if found else "http://deb.debian.org/debian"


def why_not(release):
    """Returns a text that names what is missing for such a system, or ''."""
    missing = [tool for tool in TOOLS if not shutil.which(tool)]
    if os.geteuid() != 0:
        return "needs root"
    if missing:
        return "not installed: " + ", ".join(missing)
    if release not in RELEASES:
        return f"this is none of Debian {', '.join(RELEASES)}"
    try:
        urllib.request.urlopen(f"{mirror()}/dists/{release}/Release", timeout=20).close()
    except OSError as error:
        return f"{mirror()} cannot be reached: {error}"
    return ""


def fresh_debian(release):
    base = KEPT / release
    if not (base / "finished").exists():
        shutil.rmtree(base, ignore_errors=True)
        base.mkdir(parents=True)
        subprocess.run(["debootstrap", "--variant=minbase", "--include=ca-certificates,git", release, base, mirror()], check=True,
                       stdout=subprocess.DEVNULL)
        (base / "finished").touch()
    return base


class Debian:
    """A Debian of its own below a folder, with a user `painter`; the one that is there already, or a fresh one."""

    def __init__(self, folder, release):
        self.root = Path(folder) / "root"
        self.home = self.root / "home/painter"
        self.archives = KEPT / f"archives-{release}"
        (self.archives / "partial").mkdir(parents=True, exist_ok=True)
        if self.root.exists():
            return
        self.root.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cp", "-a", "--reflink=auto", fresh_debian(release), self.root], check=True)
        for name in ("resolv.conf", "hosts", CERTIFICATES):
            shutil.copy(Path("/etc") / name, self.root / "etc" / name)
        proxies = subprocess.run(["apt-config", "dump"], capture_output=True, text=True, check=True).stdout
        (self.root / "etc/apt/apt.conf.d/proxy").write_text("".join(line + "\n" for line in proxies.splitlines() if re.match(r"Acquire::https?::Proxy", line)))
        (self.root / "usr/sbin/policy-rc.d").write_text("#!/bin/sh\nexit 101\n")
        (self.root / "usr/sbin/policy-rc.d").chmod(0o755)
        self.run("apt-get update && useradd --create-home --shell /bin/bash painter")

    def run(self, script, user="root", timeout=1800):
        """Runs a script by bash there, in the user's home folder. All its processes and mounts end with it."""
        proxies = [f"{name}={os.environ[name]}" for name in ("http_proxy", "https_proxy", "no_proxy") if name in os.environ]
        home = "/root" if user == "root" else f"/home/{user}"
        outside = ('mount -t proc proc "$0/proc" && mount -t tmpfs tmpfs "$0/dev/shm" && mkdir -p "$0/dev/pts" && '
                   'mount -t devpts -o newinstance,ptmxmode=666 devpts "$0/dev/pts" && ln -sf pts/ptmx "$0/dev/ptmx" && '
                   'mount --bind "$1" "$0/var/cache/apt/archives" && '
                   'root=$0 user=$2 && shift 2 && exec chroot --userspec="$user" "$root" "$@"')
        return subprocess.run(["unshare", "--mount", "--propagation", "private", "--pid", "--fork", "--kill-child",
                               "sh", "-c", outside, self.root, self.archives, user, "env", "-i", *proxies, f"PIP_CERT=/etc/{CERTIFICATES}", f"HOME={home}", "LC_ALL=C.UTF-8",
                               "DEBIAN_FRONTEND=noninteractive", "PATH=/usr/sbin:/usr/bin:/sbin:/bin", "bash", "-c", f"cd {home}\n{script}"],
                              capture_output=True, text=True, timeout=timeout, check=False)

    def install(self, *packages):
        return self.run("apt-get install --yes " + " ".join(packages))
