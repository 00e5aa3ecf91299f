# SPDX-License-Identifier: MIT
"""A source for drops of files: the messages of XDND 5 (freedesktop.org, "Drag-and-Drop Protocol for the X Window System")."""
import time

import Xlib.display
from Xlib import X, Xatom
from Xlib.protocol import event


def drop(screen, window_id, *paths, seconds=20):
    display = Xlib.display.Display(screen.name)
    root = display.screen().root
    source = root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
    target = display.create_resource_object("window", window_id)
    atom = display.intern_atom
    uris = atom("text/uri-list")
    source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
    place = target.translate_coords(root, 0, 0)
    x, y = -place.x + 40, -place.y + 40

    def send(kind, *data):
        values = [source.id, *data, 0, 0, 0, 0][:5]
        target.send_event(event.ClientMessage(window=target, client_type=atom(kind), data=(32, values)))
        display.flush()

    send("XdndEnter", 5 << 24, uris)
    send("XdndPosition", 0, x << 16 | y, X.CurrentTime, atom("XdndActionCopy"))
    dropped = False
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if not display.pending_events():
            time.sleep(0.01)
            continue
        e = display.next_event()
        if e.type == X.ClientMessage and e.client_type == atom("XdndStatus") and not dropped:
            assert e.data[1][1] & 1, "the window takes no drop"
            dropped = True
            send("XdndDrop", 0, X.CurrentTime)
        elif e.type == X.SelectionRequest:
            e.requestor.change_property(e.property, e.target, 8, "".join(f"file://{path}\r\n" for path in paths).encode())
            e.requestor.send_event(event.SelectionNotify(time=e.time, requestor=e.requestor, selection=e.selection, target=e.target,
                                                         property=e.property))
            display.flush()
        elif e.type == X.ClientMessage and e.client_type == atom("XdndFinished"):
            display.close()
            return
    raise AssertionError("the drop was not finished")
