# SPDX-License-Identifier: MIT
"""The desktop's portal for files, on a bus of its own, that answers as a test says."""
import shutil
import subprocess
import tempfile
import threading
from pathlib import Path

from jeepney import HeaderFields, MessageType, new_error, new_method_return, new_signal, DBusAddress
from jeepney.bus_messages import message_bus
from jeepney.io.blocking import open_dbus_connection

CONFIGURATION = """<busconfig><listen>unix:tmpdir=/tmp</listen><auth>EXTERNAL</auth>
<policy context="default"><allow send_destination="*"/><allow receive_sender="*"/><allow own="*"/></policy></busconfig>"""
HANDLE = "/org/freedesktop/portal/desktop/request/1_1/t"
CHOSEN, CANCELLED, ENDED = 0, 1, 2
WHY_NOT = "" if shutil.which("dbus-daemon") else "dbus-daemon is not installed"


class Bus:
    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        configuration = Path(self.folder.name) / "bus.conf"
        configuration.write_text(CONFIGURATION)
        self.process = subprocess.Popen(["dbus-daemon", f"--config-file={configuration}", "--nofork", "--nopidfile", "--print-address"],
                                        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.address = self.process.stdout.readline().strip()

    def close(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.folder.cleanup()


def portal_for(case):
    """A portal for the viewers of a test, and their environment."""
    bus = Bus()
    case.addCleanup(bus.close)
    return Portal(bus), {**case.screen.environment, "DBUS_SESSION_BUS_ADDRESS": bus.address}


class Portal(threading.Thread):
    """Keeps the calls that it gets: (member, parent window, title, options). `answers` says what to do with each:
    "silent", "error", None (a dialog that nobody answers), or a response and its URIs."""

    def __init__(self, bus):
        super().__init__(daemon=True)
        self.calls, self.answers = [], []
        self.connection = open_dbus_connection(bus.address)
        self.connection.send_and_get_reply(message_bus.RequestName("org.freedesktop.portal.Desktop"))
        self.start()

    def run(self):
        try:
            while True:
                self.answer(self.connection.receive())
        except (ConnectionError, OSError):
            pass

    def answer(self, message):
        if message.header.message_type != MessageType.method_call:
            return
        member = message.header.fields[HeaderFields.member]
        # Before the test sees the call, and may say what the next answer is.
        answer = None if member == "Close" else self.answers.pop(0)
        self.calls.append((member, *message.body))
        if member == "Close":
            return self.connection.send(new_method_return(message))
        if answer == "silent":
            return
        if answer == "error":
            return self.connection.send(new_error(message, "org.freedesktop.portal.Error.Failed", "s", ("it is broken",)))
        if answer:
            # Before its handle is known, as portals may: no response is lost.
            self.respond(*answer)
        self.connection.send(new_method_return(message, "o", (HANDLE,)))

    def respond(self, code, *uris):
        emitter = DBusAddress(HANDLE, interface="org.freedesktop.portal.Request")
        results = {"choices": ("a(ss)", [("a", "b")]), "uris": ("as", list(uris))} if uris else {}
        self.connection.send(new_signal(emitter, "Response", "ua{sv}", (code, results)))
