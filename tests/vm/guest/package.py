"""The package comes and goes."""

import os

from robot import CONFIG
from steps import fails, run, show, until

# What dpkg, systemd and the kernel keep of any package.
OTHERS = (
    "/etc/.pwd.lock",
    "/etc/ld.so.cache",
    "/var/cache",
    "/var/lib/dpkg",
    "/var/lib/systemd",
    "/var/log",
)


def snapshot():
    """Every file of the system, its users and groups."""
    files = run("find /etc /usr /opt /var /root /srv -xdev").splitlines()
    return {path for path in files if not path.startswith(OTHERS) and not path.endswith("-")} | set(
        run("getent passwd; getent group | cut -d: -f1").splitlines()
    )


def installs(file):
    run(f"dpkg -i {file}")
    assert run("id -nG scree") == "scree", "its other groups are the service's"
    assert run("systemctl is-enabled screed || true") == "disabled"
    assert run("systemctl is-active screed || true") == "inactive"
    assert run("stat -c '%U %a' /var/lib/scree") == "scree 755"
    assert run("scree --version") == run("screed --version")
    print("installed, neither enabled nor started")


def upgrades(file):
    """The service is started anew, and what the user has written stays."""
    with open(CONFIG) as config:
        written = config.read()
    process = show("MainPID")
    run(f"dpkg -i {file}")
    until(lambda: show("ActiveState") == "active" and show("MainPID") != process, "a new process")
    with open(CONFIG) as config:
        assert config.read() == written
    print("upgraded")


def is_removed_and_purged(before):
    run("dpkg -r scree")
    assert "inactive" in fails("systemctl is-active screed")
    assert os.path.exists(CONFIG), "the configuration outlives the package"
    run("dpkg -P scree")
    left = snapshot() - before
    assert not left, f"the purge has left {sorted(left)}"
    print("removed and purged without a trace")
