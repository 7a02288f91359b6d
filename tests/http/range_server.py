"""Serves the files of a folder over HTTP, with ranges, and with the faults that the first part of a path names.

  range_server.py FOLDER     prints its port; ends with its standard input

/plain/NAME serves; /stats tells what was asked. "Behind the head": of ranges that begin behind the first 64 KiB."""
import http.server
import json
import os
import re
import sys
import threading
import time

HEAD = 65536
lock = threading.Lock()
stats = {"connections": 0, "requests": 0, "inFlight": 0, "mostInFlight": 0, "bytes": 0}
seen = set()  # ranges that failed once


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True

    def log_message(self, *_):
        pass

    def handle(self):
        try:
            super().handle()
        except OSError:
            pass  # the client has gone

    def setup(self):
        super().setup()
        with lock:
            stats["connections"] += 1

    def do_GET(self):
        if self.path == "/stats":
            return self.answer(200, json.dumps(stats).encode())
        with lock:
            stats["requests"] += 1
            stats["inFlight"] += 1
            stats["mostInFlight"] = max(stats["mostInFlight"], stats["inFlight"])
        try:
            self.serve()
        finally:
            with lock:
                stats["inFlight"] -= 1

    def serve(self):
        _, fault, name = self.path.split("/", 2)
        path = os.path.join(sys.argv[1], name)
        if not os.path.isfile(path):
            return self.answer(404, b"no such file")
        size = os.path.getsize(path)
        first, last = map(int, re.fullmatch(r"bytes=(\d+)-(\d+)", self.headers["Range"]).groups())
        last = min(last, size - 1)
        is_behind = first >= HEAD
        with lock:
            is_first = (self.path, first) not in seen
            seen.add((self.path, first))
        with open(path, "rb") as file:
            if fault == "norange":
                return self.answer(200, file.read())
            file.seek(first)
            body = file.read(last - first + 1)
        if fault == "slow":
            time.sleep(0.05)
        if fault == "flaky" and is_first or fault == "broken" and is_behind:
            return self.answer(500, b"try again")
        if fault == "whole" and is_behind:
            return self.answer(200, body)
        grown = 1 if fault == "grown" and is_behind else 0
        is_cut = is_behind and (fault == "stall" or fault == "cut" and is_first)
        sent = body[: len(body) // 2] if is_cut else body
        self.answer(206, sent, len(body), f"bytes {first}-{last}/{size + grown}")
        if fault == "stall" and is_behind:
            time.sleep(60)
        self.close_connection |= is_cut

    def answer(self, status, body, length=None, content_range=None):
        with lock:
            stats["bytes"] += len(body)
        self.send_response(status)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        if content_range:
            self.send_header("Content-Range", content_range)
        self.end_headers()
        self.wfile.write(body)


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
server.daemon_threads = True
print(server.server_port, flush=True)
threading.Thread(target=server.serve_forever, daemon=True).start()
sys.stdin.read()
