#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""`mien view`: the page and the file go to this machine's browser, and nothing else goes anywhere.

    cli_view_test.py path/to/mien [unittest options]      (or MIEN_BIN=path/to/mien)
"""
import ctypes.util
import http.client
import json
import os
import shutil
import signal
import socket
import stat
import struct
import subprocess
import sys
import time
import unittest
from urllib.parse import parse_qs, quote, urlsplit

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "tests", "support"))
import program  # noqa: E402
from program import USAGE, INVALID, FILE, ProgramTest, main, make, make_folder, path, read, run, write  # noqa: E402

WITHOUT_SERVER = ""
PAGE = {"index.html": b"<!doctype html><title>page</title>", "viewer.js": b"export {};\n",
        "viewer.css": b"body {}\n", "mien/mien.wasm": b"\0asm\1\0\0\0", "three/LICENSE": b"secret"}


def setUpModule():
    global WITHOUT_SERVER
    make_folder()
    make("gen", "-o", path("tiny.dna"), "--preset", "tiny")
    make("bake", path("tiny.dna"), "-o", path("tiny.rig"))
    for name, content in PAGE.items():
        os.makedirs(os.path.dirname(path("page/" + name)), exist_ok=True)
        write("page/" + name, content)
    write("secret.js", "secret")
    os.symlink(path("secret.js"), path("page/linked.js"))
    said = run("view", "--page", path("nowhere")).stderr
    if "no web server" in said:
        WITHOUT_SERVER = "NOT TESTED: mien view; this build has no cpp-httplib"


class View(ProgramTest):
    running = None

    def setUp(self):
        if WITHOUT_SERVER:
            self.skipTest(WITHOUT_SERVER)

    def start(self, *arguments, env=None, stdin=None, opens=False):
        """A running program, and its address."""
        self.end()
        options = [] if opens else ["--no-open"]
        self.running = subprocess.Popen(
            [program.mien, "view", "--page", path("page"), *options, *arguments], stdin=stdin,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, env={**os.environ, **(env or {})})
        self.addCleanup(self.end)
        url = self.running.stdout.readline().decode().strip()
        self.assertTrue(url.startswith("http://127.0.0.1:"), url)
        self.port = urlsplit(url).port
        return url

    def end(self):
        running, self.running = self.running, None
        if running is not None:
            if running.poll() is None:
                running.kill()
            running.communicate()

    def ask(self, where, method="GET", **headers):
        """(status, headers, body)"""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=20)
        try:
            connection.putrequest(method, where, skip_host="Host" in headers)
            for name, value in headers.items():
                if value is not None:
                    connection.putheader(name, value)
            connection.endheaders()
            answer = connection.getresponse()
            return answer.status, answer.headers, answer.read()
        finally:
            connection.close()

    def test_the_page_and_the_file_are_served(self):
        url = self.start(path("tiny.dna"))
        wanted = parse_qs(urlsplit(url).query)["file"][0]
        for name, kind, content in (
                ("/", "text/html", PAGE["index.html"]), ("/index.html", "text/html", PAGE["index.html"]),
                ("/viewer.js", "text/javascript", PAGE["viewer.js"]), ("/viewer.css", "text/css", PAGE["viewer.css"]),
                ("/mien/mien.wasm", "application/wasm", PAGE["mien/mien.wasm"]),
                ("/" + wanted, "application/octet-stream", read("tiny.dna"))):
            status, headers, body = self.ask(name)
            self.assertEqual((status, body), (200, content), name)
            self.assertEqual(headers["Content-Type"].split(";")[0], kind)
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
            self.assertEqual(headers["Cross-Origin-Resource-Policy"], "same-origin")

    def test_nothing_else_is_served(self):
        self.start(path("tiny.dna"))
        for where in ("/three/LICENSE", "/linked.js", "/../secret.js", "/%2e%2e/secret.js", "/mien/../../secret.js",
                      "/mien", "/mien/", "//etc/passwd", "/etc/passwd", "/rig/", "/rig/other.dna", "/rig/..%2ftiny.dna",
                      "/" + "a" * 7000, "/viewer.js%00", "/viewer.js/"):
            status, _, body = self.ask(where)
            self.assertIn(status, (400, 404, 414), where)
            self.assertNotIn(b"secret", body)
            self.assertNotIn(b"root:", body)
        self.assertEqual(self.ask("/viewer.js")[0], 200)

    def test_other_hosts_are_refused(self):
        self.start(path("tiny.dna"))
        for host in ("evil.example", f"evil.example:{self.port}", "127.0.0.1", "127.0.0.1:1", "localhost", None,
                     f"127.0.0.1.evil.example:{self.port}", f"0.0.0.0:{self.port}"):
            status, _, body = self.ask("/rig/tiny.dna", Host=host)
            self.assertIn(status, (400, 403), host)
            self.assertLess(len(body), 100)
        for host in (f"127.0.0.1:{self.port}", f"localhost:{self.port}"):
            self.assertEqual(self.ask("/", Host=host)[0], 200)

    def test_only_get(self):
        self.start()
        for method in ("HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH"):
            status, headers, _ = self.ask("/viewer.js", method)
            self.assertEqual(status, 405, method)
            self.assertEqual(headers["Allow"], "GET")
        self.assertIn(self.ask("/viewer.js", "BREW")[0], (400, 405))

    def test_ranges_get_the_whole_file(self):
        """Also those past its end, which would be memory of the program."""
        self.start(path("tiny.dna"))
        for where, whole in (("/viewer.js", PAGE["viewer.js"]), ("/rig/tiny.dna", read("tiny.dna"))):
            for ranges in ("0-1", "0-1,3-4", "0-,0-,0-", "-3", "100-200", "0-1,100-200", "0-99999999999",
                           "1000000000-1000001000", "-99999999", ",".join(["0-"] * 500)):
                status, headers, body = self.ask(where, Range="bytes=" + ranges)
                if status != 416:
                    self.assertEqual((status, body), (200, whole), ranges)
                    self.assertNotIn("Content-Range", headers)
            for wrong in ("5-2", "x", "", "1-x", "--1", "0-1;2-3"):
                status, _, body = self.ask(where, Range="bytes=" + wrong)
                self.assertIn(status, (200, 400, 416), wrong)
                self.assertIn(body, (whole, b""), wrong)

    def test_garbage_leaves_it_alive(self):
        self.start()
        for garbage in (b"", b"\r\n\r\n", b"GET\r\n\r\n", b"\xff\xfe\0\0" * 100, b"GET / HTTP/1.1\r\n" + b"x: y\r\n" * 5000,
                        b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", self.port), timeout=20) as one:
                try:
                    one.sendall(garbage)
                    one.shutdown(socket.SHUT_WR)
                except OSError:
                    pass  # it has hung up already
        self.assertEqual(self.ask("/")[0], 200)

    def test_slow_clients_do_not_stop_it(self):
        """Clients that send a byte now and then, or never read: each has its thread for 20 s at most."""
        self.start(path("tiny.dna"))
        slow = [socket.create_connection(("127.0.0.1", self.port), timeout=60) for _ in range(12)]
        try:
            begin = time.monotonic()
            for one in slow:
                one.sendall(b"GET / HTTP/1.1\r\n")
            self.assertEqual(self.ask("/")[0], 200)  # meanwhile
            open_still = list(slow)
            while open_still and time.monotonic() - begin < 60:
                for one in list(open_still):
                    try:
                        one.sendall(b"X: y\r\n")  # never the empty line
                    except OSError:
                        open_still.remove(one)
                time.sleep(0.5)
            self.assertEqual(open_still, [])
            self.assertGreater(time.monotonic() - begin, 10)
        finally:
            for one in slow:
                one.close()
        self.assertEqual(self.ask("/")[0], 200)

    def test_it_ends_by_a_signal(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            self.start(path("tiny.rig"))
            self.running.send_signal(number)
            self.assertEqual(self.running.wait(timeout=20), 0)
            self.assertEqual(self.running.stderr.read().decode(), "mien: note: Ctrl+C ends it\n")
            with self.assertRaises(OSError):
                self.ask("/")

    def test_names_of_files_survive(self):
        name = path("ä 100% #&?.dna")
        write(name, read("tiny.dna"))
        url = self.start(name)
        wanted = parse_qs(urlsplit(url).query)["file"][0]
        self.assertEqual(wanted, "rig/" + quote(os.path.basename(name), safe="-._~"))
        self.assertEqual(self.ask("/" + wanted)[2], read("tiny.dna"))

    def test_standard_input_and_glb(self):
        with open(path("tiny.rig"), "rb") as file:
            self.start("-", stdin=file)
        self.assertEqual(self.ask("/rig/standard-input")[2], read("tiny.rig"))
        self.end()
        write("head.model", b"glTF\2\0\0\0\14\0\0\0")
        self.assertTrue(self.start(path("head.model")).endswith("?file=rig/head.model.glb"))

    def test_a_port_is_chosen_and_may_be_taken(self):
        with socket.socket() as one:
            one.bind(("127.0.0.1", 0))
            free = one.getsockname()[1]
        self.assertEqual(urlsplit(self.start("--port", str(free))).port, free)
        self.fails(FILE, "view", "--page", path("page"), "--port", str(free), "--no-open", says=f"port {free}")
        for wrong in ("0", "65536", "-1", "x"):
            self.fails(USAGE, "view", "--page", path("page"), "--port", wrong, "--no-open", says="--port")

    def test_it_listens_on_this_machine_alone(self):
        self.start()
        with open("/proc/net/tcp", encoding="ascii") as table:
            listening = [line.split()[1] for line in table if line.split()[3] == "0A"]
        hosts = [place.split(":")[0] for place in listening if int(place.split(":")[1], 16) == self.port]
        self.assertEqual(hosts, ["0100007F" if sys.byteorder == "little" else "7F000001"])

    def test_the_browser_gets_the_address(self):
        os.makedirs(path("bin"), exist_ok=True)
        opener = write("bin/xdg-open", f"#!/bin/sh\nprintf '%s' \"$1\" > {path('asked.tmp')}\n"
                                       f"mv {path('asked.tmp')} {path('asked')}\n")
        os.chmod(opener, stat.S_IRWXU)
        where = {"PATH": path("bin") + os.pathsep + os.environ["PATH"], "DISPLAY": ":99"}
        url = self.start(path("tiny.dna"), env=where, opens=True)
        for _ in range(200):
            if os.path.exists(path("asked")):
                break
            time.sleep(0.05)
        self.assertEqual(read("asked").decode(), url)

    def test_what_is_no_rig_is_refused_before_anything_is_served(self):
        rig = read("tiny.dna")
        for name, content in (("empty", b""), ("text.csv", b"time,jawOpen\n0,1\n"), ("cut.dna", rig[:len(rig) // 2]),
                              ("cut.rig", read("tiny.rig")[:200])):
            self.fails(INVALID, "view", "--page", path("page"), write(name, content), "--no-open", says=name)
        self.fails(FILE, "view", "--page", path("page"), path("missing.dna"), says="missing.dna")

    def listening_port(self):
        while True:
            line = self.running.stderr.readline().decode()
            self.assertTrue(line, "it has ended")
            if "listening on" in line:
                return int(line.rsplit(":", 1)[1])

    def test_what_the_rig_plays_comes_with_it(self):
        """Files as they are; of scenes the clips that they name, the takes of what they say, and its sound."""
        def clip(name):
            write("said.json", json.dumps({"phonemes": [{"label": "m", "begin": 0, "end": 0.2}, {"label": "a", "begin": 0.2, "end": 0.4}]}))
            self.ok("speak", "--phonemes", path("said.json"), "-o", path(name))
        clip("a part.clip")
        write("voice.wav", b"RIFF")
        said = {"speech": {"phonemes": "said.json"}}
        write("scene.json", json.dumps({"seconds": 2, "layers": [
            {"name": "talk", "source": said}, {"name": "more", "source": {"clip": "a part.clip"}},
            {"name": "again", "source": said}, {"name": "hear", "source": {"live": True}}],
            "events": [{"time": 1, "layer": "talk", "play": {"speech": {**said["speech"]}}},
                       {"time": 0.5, "layer": "talk", "play": {"clip": "a part.clip"}}]}))
        url = self.start(path("tiny.dna"), path("voice.wav"), path("scene.json"))
        more = parse_qs(urlsplit(url).query)["more"]
        self.assertEqual(more, ["rig/voice.wav", "rig/talk.speech.clip", "rig/a%20part.clip", "rig/scene.json"])
        for where, name in zip(more, ("voice.wav", None, "a part.clip", "scene.json")):
            status, _, body = self.ask("/" + where)
            self.assertEqual(status, 200)
            self.assertEqual(body, read(name or "a part.clip"), where)
        # A text is heard.
        scene = {"layers": [{"name": "talk", "source": {"speech": {"text": "Mama."}}}],
                 "events": [{"time": 1, "layer": "talk", "play": {"speech": {"text": "Papa."}}}]}
        write("scene.json", json.dumps(scene))
        if ctypes.util.find_library("espeak-ng") is None:
            print("NOT TESTED: the sound of a scene in mien view; espeak-ng is not installed")
            self.fails(FILE, "view", "--page", path("page"), path("tiny.dna"), path("scene.json"), "--no-open", says="espeak-ng")
        else:
            more = parse_qs(urlsplit(self.start(path("tiny.dna"), path("scene.json"))).query)["more"]
            self.assertEqual(more, ["rig/talk.speech.clip", "rig/talk-2.speech.clip", "rig/scene.json", "rig/talk.wav"])
            self.ok("speak", "Mama.", "-o", path("mama.clip"), "--wav", path("mama.wav"))
            self.assertEqual(self.ask("/rig/talk.speech.clip")[2], read("mama.clip"))
            self.assertEqual(self.ask("/rig/talk.wav")[2], read("mama.wav"))

    def test_what_is_nothing_to_play_is_refused(self):
        page = "view", "--page", path("page"), "--no-open", path("tiny.dna")
        self.fails(USAGE, *page, path("tiny.dna"), says="nothing that a rig plays")
        self.fails(FILE, *page, path("missing.clip"), says="missing.clip")
        self.fails(INVALID, *page, write("scene.json", '{"layers": [{"name": "a"}]}'), says="scene.json")
        self.fails(FILE, *page, write("scene.json", '{"layers": [{"name": "a", "source": {"clip": "none.clip"}}]}'), says="none.clip")
        # Scenes may be from elsewhere: of what they name, only clips are served.
        self.fails(INVALID, *page, write("scene.json", '{"layers": [{"name": "a", "source": {"clip": "secret.js"}}]}'), says="secret.js")
        self.fails(INVALID, "view", "--page", path("page"), "--no-open", path("scene.json"), says="name a rig first")

    def test_live_data_are_sent_to_the_page(self):
        """A packet of Live Link Face becomes a line for each page that asks; answers end when the program ends."""
        make("gen", "-o", path("live.dna"), "--preset", "medium")
        make("bake", path("live.dna"), "-o", path("live.rig"), "--force")
        for rig in ("live.dna", "live.rig"):
            url = self.start(path(rig), "--live", "livelink://127.0.0.1:0", "--delay", "0")
            self.assertEqual(parse_qs(urlsplit(url).query)["live"], ["live"])
            port = self.listening_port()
            asked = [http.client.HTTPConnection("127.0.0.1", self.port, timeout=20) for _ in range(2)]
            for connection in asked:
                connection.request("GET", "/live")
            answers = [connection.getresponse() for connection in asked]
            names = [json.loads(answer.readline())["names"] for answer in answers]
            self.assertEqual(names[0], names[1])
            jaw = names[0].index("CTRL_expressions.jawOpen")
            phone = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            self.addCleanup(phone.close)
            values = [0.0] * 61
            values[17] = 0.625
            for answer in answers:
                for frame in range(1, 1200):  # until one has come through
                    phone.sendto(b"".join((b"\6", struct.pack(">i", 5), b"phone", struct.pack(">i", 4), b"face", struct.pack(
                        ">ifiiB61f", int(time.monotonic() * 60), 0.0, 60, 1, 61, *values))), ("127.0.0.1", port))
                    row = json.loads(answer.readline())
                    if row[jaw] == 0.625:
                        break
                self.assertEqual((row[jaw], len(row)), (0.625, len(names[0])))
            self.running.send_signal(signal.SIGINT)
            for answer in answers:
                answer.read()  # to its end
            self.assertEqual(self.running.wait(timeout=20), 0)
            self.assertIn(b"received", self.running.stderr.read())

    def test_live_data_need_a_rig_and_a_source(self):
        page = ("view", "--page", path("page"), "--no-open")
        self.fails(USAGE, *page, "--live", "livelink://:0", says="there is no rig")
        self.fails(USAGE, *page, path("tiny.dna"), "--delay", "0.1", says="--live")
        self.fails(USAGE, *page, path("tiny.dna"), "--names", path("page/viewer.js"), says="--live")
        self.fails(USAGE, *page, path("tiny.dna"), "--live", "tcp://:1", says="--live")
        self.fails(USAGE, *page, path("tiny.dna"), "--live", "landmarks3://:0", says="mien play")
        write("some.glb", b"glTF\2\0\0\0\14\0\0\0")
        self.fails(USAGE, *page, path("some.glb"), "--live", "livelink://127.0.0.1:0", says="GLB")
        self.start(path("tiny.dna"))
        self.assertEqual(self.ask("/live")[0], 404)

    def test_a_missing_server_is_told_with_what_to_do(self):
        moved = path("moved/bin/mien")
        os.makedirs(os.path.dirname(moved), exist_ok=True)
        shutil.copy(program.mien, moved)
        libraries = os.path.join(os.path.dirname(os.path.dirname(program.mien)), "lib")
        done = subprocess.run([moved, "view", path("tiny.dna"), "--page", path("page"), "--no-open"], capture_output=True,
                              text=True, timeout=60, env={**os.environ, "LD_LIBRARY_PATH": libraries})
        self.assertEqual(done.returncode, FILE)
        self.assertIn("view_server", done.stderr)
        self.assertIn("install mien again", done.stderr)

    def test_a_missing_page_is_told_with_what_to_do(self):
        self.fails(FILE, "view", "--page", path("bin-nowhere"), says="dev web build")


if __name__ == "__main__":
    main()
