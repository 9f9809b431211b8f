#!/usr/bin/env python3
"""browser.py FOLDER PAGE... [--FLAG...]: opens pages of a folder in one headless Chromium, and waits for what they send back.

A page fetches files of the folder from the server that it came from. It sends: POST NAME with the bytes of a file,
which is written beside it; POST done with a line that ends its run, "ok", "skipped: why" or what is wrong. Where all is well
the answer to that is the page to open next, if there is one. Ends with 0, 77 or 1."""
import contextlib
import http.server
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time

FLAGS = ["--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars",
         "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--enable-unsafe-webgpu",
         "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan"]
LONGEST = float(os.environ.get("ACDF_BROWSER_SECONDS", 300))


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".wasm": "application/wasm",
                      ".js": "text/javascript", ".mjs": "text/javascript"}

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.send_response(200)
        self.end_headers()
        if os.path.basename(self.path) == "done":
            self.server.answer = body.decode()
            if self.server.answer == "ok" and self.server.pages:
                self.wfile.write(("/" + self.server.pages.pop(0)).encode())
            else:
                self.server.answered.set()
        else:
            with open(self.translate_path(self.path), "wb") as file:
                file.write(body)

    def log_message(self, *arguments):
        pass


def end_group(leader):
    """Ends what a program that led a session has left behind, and waits until it is gone."""
    with contextlib.suppress(ProcessLookupError):
        for _ in range(100):
            os.killpg(leader, signal.SIGKILL)
            time.sleep(0.05)


def main(folder, page, *pages_and_flags):
    flags = [word for word in pages_and_flags if word.startswith("--")]
    server = http.server.ThreadingHTTPServer(
        ("127.0.0.1", 0), lambda *arguments: Handler(*arguments, directory=folder))
    server.pages = [word for word in pages_and_flags if word not in flags]
    longest = LONGEST * (1 + len(server.pages))
    server.answered, server.answer = threading.Event(), "no answer within %.0f s" % longest
    threading.Thread(target=server.serve_forever, daemon=True).start()
    # Helpers of the browser may outlive it for a moment, and write to the profile while it is removed.
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        with open(os.path.join(folder, "browser.log"), "w", encoding="utf-8") as log:
            browser = subprocess.Popen(
                ["chromium", *FLAGS, *flags, "--enable-logging=stderr", "--user-data-dir=" + profile,
                 "http://127.0.0.1:%d/%s" % (server.server_port, page)],
                stdout=log, stderr=log, env={**os.environ, "HOME": profile, "TMPDIR": profile}, start_new_session=True)
            server.answered.wait(longest)
            browser.terminate()
            browser.wait()
            end_group(browser.pid)
    server.shutdown()
    print(server.answer)
    if server.answer.startswith("skipped"):
        return 77
    if server.answer != "ok":
        with open(os.path.join(folder, "browser.log"), encoding="utf-8", errors="replace") as log:
            sys.stderr.write("".join(line for line in log if "CONSOLE" in line))
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
