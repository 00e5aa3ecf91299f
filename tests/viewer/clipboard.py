# SPDX-License-Identifier: MIT
"""The CLIPBOARD selection of an X display: owned with a text, or read (ICCCM 2)."""
import threading
import time

import Xlib.display
from Xlib import X, Xatom
from Xlib.protocol import event


class Clipboard:
    """Owns the clipboard with this text until it is closed, or another client takes it."""

    def __init__(self, screen, text):
        self.text = text.encode()
        self.display = Xlib.display.Display(screen.name)
        self.window = self.display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        self.window.set_selection_owner(self.display.intern_atom("CLIPBOARD"), X.CurrentTime)
        self.display.sync()
        self.ends = threading.Event()
        self.thread = threading.Thread(target=self.serve)
        self.thread.start()

    def serve(self):
        atom = self.display.intern_atom
        while not self.ends.is_set():
            if not self.display.pending_events():
                time.sleep(0.01)
                continue
            e = self.display.next_event()
            if e.type != X.SelectionRequest:
                continue
            if e.target == atom("TARGETS"):
                e.requestor.change_property(e.property, Xatom.ATOM, 32, [atom("UTF8_STRING")])
            else:
                e.requestor.change_property(e.property, e.target, 8, self.text)
            e.requestor.send_event(event.SelectionNotify(time=e.time, requestor=e.requestor, selection=e.selection, target=e.target,
                                                         property=e.property))
            self.display.flush()

    def close(self):
        self.ends.set()
        self.thread.join()
        self.display.close()


def clipboard_text(screen, seconds=20):
    display = Xlib.display.Display(screen.name)
    window = display.screen().root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
    kind, place = display.intern_atom("UTF8_STRING"), display.intern_atom("TEXT_THAT_IS_READ")
    window.convert_selection(display.intern_atom("CLIPBOARD"), kind, place, X.CurrentTime)
    display.flush()
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if not display.pending_events():
            time.sleep(0.01)
            continue
        if display.next_event().type == X.SelectionNotify:
            text = window.get_full_property(place, kind)
            display.close()
            value = text.value if text else b""
            return value.decode() if isinstance(value, bytes) else value
    raise AssertionError("nobody gives the clipboard's text")
