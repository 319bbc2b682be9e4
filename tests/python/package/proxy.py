"""A line to the real server that breaks: a proxy of bytes that hangs up as it is told."""

import socket
import threading


class Line:
    """Listens on `url`. `cut_after(n)`: each connection is closed after n bytes of answer; 0: before any of it."""

    def __init__(self, server):
        host, port = server.removeprefix("http://").split(":")
        self.server = (host, int(port))
        self.limits = []
        self.connections = 0
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self.listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def cut_after(self, *limits):
        """One limit for each of the next connections; those behind are whole."""
        self.limits = list(limits)

    def _accept(self):
        while True:
            try:
                caller, _ = self.listener.accept()
            except OSError:
                return
            self.connections += 1
            limit = self.limits.pop(0) if self.limits else None
            server = socket.create_connection(self.server)
            threading.Thread(target=_pass, args=(caller, server, None), daemon=True).start()
            threading.Thread(target=_pass, args=(server, caller, limit), daemon=True).start()

    def close(self):
        self.listener.close()


def _pass(source, target, limit):
    passed = 0
    try:
        while data := source.recv(4096):
            if limit is not None and passed + len(data) >= limit:
                target.sendall(data[: limit - passed])
                break
            target.sendall(data)
            passed += len(data)
    except OSError:
        pass
    for end in (source, target):
        try:
            end.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass
        end.close()
