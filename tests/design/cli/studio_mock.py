# SPDX-License-Identifier: MIT
"""A stand-in for the server of `fettle studio`, which speaks its protocol (docs/studio.md): the page, events, calls. Parts, motion and pairs
are those of a report; numbers are linear in the parameters but for a little, and come when the test lets them."""
import base64
import copy
import http.server
import json
import math
import pathlib
import queue
import struct
import threading
import time
import urllib.parse

# The first body and the second slide along x, with the second hanging on the first, which turns it about z.
JOINTS = [{"name": "slide", "unit": "mm", "start": 0, "low": -30, "high": 40, "has_limits": False},
          {"name": "hinge", "unit": "deg", "start": 0, "low": -90, "high": 170, "has_limits": True}]
KINDS = ("asked", "progress", "refused", "motion", "numbers", "gradient", "pairs", "settled")
POLICY = "default-src 'none'"


def page_of(template, data, studio=True):
    """The page with its data. Only the studio's may connect, to where it came from."""
    assert template.count("@FETTLE_REPORT_DATA@") == 1 and template.count(POLICY) == 1
    if studio:
        template = template.replace(POLICY, POLICY + "; connect-src 'self'")
    return template.replace("@FETTLE_REPORT_DATA@", json.dumps(data).replace("<", "\\u003c"))


def data_of(report):
    text = pathlib.Path(report).read_text()
    begin = text.index('id="fettle-report">') + len('id="fettle-report">')
    return json.loads(text[begin:text.index("</script>", begin)])


def floats(packed):
    key, text = next(iter(packed.items()))
    letter = {"f32": "f", "f64": "d"}[key]
    raw = base64.b64decode(text)
    return struct.unpack(f"<{len(raw) // struct.calcsize(letter)}{letter}", raw)


def scaled(mesh, factor):
    """Its heights multiplied."""
    key, numbers = next(iter(mesh["vertices"])), list(floats(mesh["vertices"]))
    letter = {"f32": "f", "f64": "d"}[key]
    numbers[2::3] = [factor * z for z in numbers[2::3]]
    return mesh | {"vertices": {key: base64.b64encode(struct.pack(f"<{len(numbers)}{letter}", *numbers)).decode()}}


class Refused(Exception):
    """A call cannot be done: the sentence says why, `more` what else the answer has."""

    def __init__(self, sentence, **more):
        super().__init__(sentence)
        self.more = more


class StudioMock:
    """`report`: of an optimisation. `slopes`: of the objective ("objective") and each requirement by each parameter. `tall`: the parameter
    that makes meshes taller; above `refused_above` the design cannot be made."""

    def __init__(self, template, report, slopes, tall, refused_above):
        self.template, self.report, self.slopes, self.tall, self.refused_above = template, report, slopes, tall, refused_above
        self.parameters = [{"name": p["name"], "unit": p["unit"], "value": p["end"], "lower": p["lower"], "upper": p["upper"]} for p in report["parameters"]]
        self.values = self.file_values
        self.past, self.future, self.revision, self.evaluated = [], [], 0, 0
        self.lock, self.clients, self.writer, self.calls, self.token = threading.RLock(), {}, None, [], "s3cret"
        self.joints = JOINTS
        self.newest, self.gates, self.tuning, self.files = {}, {kind: threading.Event() for kind in KINDS}, None, set()
        self.delay, self.flying, self.most_flying = 0, 0, 0  # calls: what each takes [s], how many there are, and were, at once
        for gate in self.gates.values():
            gate.set()
        self.newest["opened"] = self.opened()
        self.wake = threading.Condition(self.lock)
        self.start(0)
        threading.Thread(target=self.evaluate_always, daemon=True).start()
        self.ask()

    def start(self, port):
        mock = self

        class Handler(http.server.BaseHTTPRequestHandler):
            def log_message(self, *_):
                pass

            def do_GET(self):
                mock.get(self)

            def do_POST(self):
                mock.post(self)

        http.server.ThreadingHTTPServer.daemon_threads = True
        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", port), Handler)
        self.origin = f"http://127.0.0.1:{self.server.server_address[1]}"
        self.address = f"{self.origin}/?token={self.token}"
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def stop(self):
        """As the program does where it ends: the connections too."""
        self.server.shutdown()
        self.server.server_close()
        with self.lock:
            for events in self.clients.values():
                events.put(None)
            self.clients.clear()

    def again(self):
        """At the same address."""
        self.start(self.server.server_address[1])

    @property
    def file_values(self):
        return {p["name"]: p["value"] for p in self.parameters}

    # What the page is told.

    def opened(self):
        report, after = self.report, next(view for view in self.report["views"] if view["name"] == "after")
        still = after | {"times": {"f64": base64.b64encode(struct.pack("<d", 0)).decode()}, "bodies": [self.still(body) for body in after["bodies"]]}
        unknown = [row | {"lower": None, "upper": None, "proven": False, "met": False, "pair": None, "fault": None} for row in report["requirements"]]
        return {"format": 1, "kind": "studio", "program": report["program"], "name": report["name"], "file": "small.design.json", "folder": ".",
                "command": "fettle studio small.design.json", "up": report["up"], "description": report["description"], "revision": self.revision,
                "values": self.values, "parameters": self.parameters, "requirements": unknown, "objective": [{"name": "mass", "unit": "g", "weight": 1}],
                "motion": False, "steps": 0, "step": 0, "duration": 0, "meshes": report["meshes"], "views": [still], "pairs": [], "pair_count": 0, "margins": None,
                "scenarios": [], "notices": [], "joints": self.told_joints(), "can_undo": bool(self.past), "can_redo": bool(self.future), "saved": self.values == self.file_values}

    @staticmethod
    def still(body):
        key, text = next(iter(body["poses"].items()))
        return body | {"poses": {key: base64.b64encode(base64.b64decode(text)[:7 * {"f32": 4, "f64": 8}[key]]).decode()}}

    def value(self, name, base):
        by = self.slopes.get(name, {})
        return base + sum(slope * (self.values[p] - self.file_values[p]) + 0.01 * abs(slope) * (self.values[p] - self.file_values[p]) ** 2 for p, slope in by.items())

    def rows(self):
        rows = copy.deepcopy(self.report["requirements"])
        for row in rows:
            row["lower"], row["upper"] = (self.value(row["name"], row[side]) for side in ("lower", "upper"))
            row["met"] = not (row["required_lower"] is not None and row["lower"] < row["required_lower"]) and not (
                row["required_upper"] is not None and row["upper"] > row["required_upper"])
        return rows

    def numbers(self):
        rows = self.rows()
        missed = [row["name"] for row in rows if not row["met"]]
        return {"requirements": rows, "objective": {"value": self.objective(), "start": self.report["objective"]["end"]}, "met": not missed,
                "message": f"{len(missed)} of {len(rows)} requirements are not met" if missed else "every requirement is met", "seconds": 0.1}

    def objective(self):
        return self.value("objective", self.report["objective"]["end"])

    def motion(self):
        report, factor = self.report, self.values[self.tall] / self.file_values[self.tall]
        after = [view for view in report["views"] if view["name"] == "after"]
        mesh = after[0]["bodies"][1]["mesh"]
        return {"motion": report["motion"], "steps": report["steps"], "step": report["step"], "duration": report["duration"],
                "meshes": [scaled(each, factor) if k == mesh else each for k, each in enumerate(report["meshes"])], "views": after,
                "joints": self.told_joints()}

    # Moved by hand.

    def bodies(self):
        return next(view for view in self.report["views"] if view["name"] == "after")["bodies"]

    def told_joints(self):
        names = [body["name"] for body in self.bodies()]
        return [joint | {"moves": moves} for joint, moves in zip(self.joints, (names[:2], names[1:2]))]

    def poses(self, slide, hinge):
        """x y z and the quaternion x y z w of each body; hinge in rad, about the middle of the first body."""
        poses = [list(floats(body["poses"])[:7]) for body in self.bodies()]
        (cx, cy), turn = poses[0][:2], (math.sin(hinge / 2), math.cos(hinge / 2))
        x, y, (qx, qy, qz, qw) = poses[1][0] - cx, poses[1][1] - cy, poses[1][3:]
        poses[1] = [cx + x * math.cos(hinge) - y * math.sin(hinge), cy + x * math.sin(hinge) + y * math.cos(hinge), poses[1][2],
                    turn[1] * qx - turn[0] * qy, turn[1] * qy + turn[0] * qx, turn[1] * qz + turn[0] * qw, turn[1] * qw - turn[0] * qz]
        for pose in poses[:2]:
            pose[0] += slide
        return poses

    def ends(self, body, pose):
        """From where to where it reaches along x, of one that turns about z alone."""
        vertices, angle = floats(self.report["meshes"][body["mesh"]]["vertices"]), 2 * math.atan2(pose[5], pose[6])
        along = [pose[0] + x * math.cos(angle) - y * math.sin(angle) for x, y in zip(vertices[0::3], vertices[1::3])]
        return min(along), max(along)

    def do_pose(self, body, _):
        if "motion" not in self.newest:
            raise Refused("nothing has been simulated yet")
        joints = {joint["name"]: body["joints"].get(joint["name"], joint["start"]) for joint in self.joints}
        poses, bodies = self.poses(joints["slide"], math.radians(joints["hinge"])), self.bodies()
        wall = self.ends(bodies[2], poses[2])[0] - 0.013  # so that no step ends at it
        rows = [self.posed_row(bodies, k, 2, wall - self.ends(bodies[k], poses[k])[1], wall, poses[k]) for k in (0, 1)]
        rows.append(self.posed_row(bodies, 0, 1, 0.12, 0, poses[1]))
        rows.sort(key=lambda row: row["upper"] or 0)
        for row in rows:
            if row["depth"] and not body.get("depth", True):
                row["depth"] = None
        return {"poses": {"f32": base64.b64encode(struct.pack("<21f", *(x for pose in poses for x in pose))).decode()}, "pairs": rows}

    @staticmethod
    def posed_row(bodies, a, b, gap, x, pose):
        clashes, at = gap < 0, [x, pose[1], pose[2]]
        return {"a": bodies[a]["name"], "b": bodies[b]["name"], "body_a": a, "body_b": b, "motion": True, "steps": [0, 0], "minimum": None,
                "lower": None if clashes else gap - 1e-6, "upper": None if clashes else gap + 1e-6, "status": "violated" if clashes else "clear",
                "finding": "clash" if clashes else "apart", "time": 0, "point_a": [x - gap, *at[1:]], "point_b": at,
                "depth": {"lower": -gap, "upper": -gap, "time": 0, "point": at} if clashes else None, "volume": None, "touching": None, "note": None}

    def gradient(self):
        units = {row["name"]: row["unit"] for row in self.report["requirements"]} | {"objective": "g"}
        return {"rows": [{"of": "objective" if name == "objective" else "requirement", "name": name, "unit": units[name], "by": by} for name, by in self.slopes.items()]}

    def pairs(self):
        pairs = copy.deepcopy(self.report["pairs"])
        for row in self.rows():
            if row["pair"] is not None:
                pairs[row["pair"]].update(lower=row["lower"], upper=row["upper"])
        return {"pairs": pairs, "pair_count": len(pairs), "margins": self.report["margins"]}

    # Evaluations: the last values that were asked for.

    def tell(self, name, data):
        with self.lock:
            if name != "writer":
                self.newest[name] = data
            for events in self.clients.values():
                events.put((name, data))

    def ask(self):
        with self.lock:
            before = self.newest.get("asked", {}).get("values", {})
            self.revision += 1
            for kind in KINDS:
                self.newest.pop(kind, None)
            self.tell("asked", {"revision": self.revision, "values": self.values, "changed": [n for n, x in self.values.items() if before.get(n) != x],
                                "can_undo": bool(self.past), "can_redo": bool(self.future), "saved": self.values == self.file_values})
            self.wake.notify_all()
            return self.revision

    def set(self, values):
        with self.lock:
            self.past.append(self.values)
            self.future = []
            self.values = self.values | values
            return self.ask()

    def evaluate_always(self):
        while True:
            with self.wake:
                self.wake.wait_for(lambda: self.revision != self.evaluated)
                revision = self.evaluated = self.revision
            self.evaluate(revision)

    def evaluate(self, revision):
        def give(kind, what):
            while not self.gates[kind].wait(0.02):
                if self.revision != revision:
                    return False
            with self.lock:
                if self.revision != revision:
                    return False
                self.tell(kind, {"revision": revision} | what())
            return True

        for step in range(3):
            if not give("progress", lambda step=step: {"doing": "simulating", "step": step, "steps": 3}):
                return
        if self.values[self.tall] > self.refused_above:
            give("refused", lambda: {"reason": f"{self.tall}: parts intersect at the start"})
            return
        for kind in ("motion", "numbers", "gradient", "pairs"):
            if not give(kind, getattr(self, kind)):
                return
        give("settled", lambda: {"seconds": 0.12})

    # What the page asks for.

    def get(self, request):
        url = urllib.parse.urlparse(request.path)
        query = dict(urllib.parse.parse_qsl(url.query))
        if query.get("token") != self.token or url.path not in ("/", "/events"):
            request.send_error(403)
        elif url.path == "/":
            self.answer(request, 200, page_of(self.template, self.opened()).encode(), "text/html; charset=utf-8")
        else:
            self.stream(request, query.get("client", ""))

    @staticmethod
    def answer(request, status, body, kind="application/json"):
        request.send_response(status)
        request.send_header("Content-Type", kind)
        request.send_header("Content-Length", str(len(body)))
        request.end_headers()
        request.wfile.write(body)

    def stream(self, request, client):
        events = queue.Queue()
        with self.lock:
            self.clients[client] = events
            self.writer = self.writer if self.writer in self.clients else client
            for name in sorted(self.newest, key=lambda name: ("opened", "fault", *KINDS, "tune").index(name)):
                events.put((name, self.newest[name]))
            self.tell_writers()
        try:
            request.send_response(200)
            request.send_header("Content-Type", "text/event-stream")
            request.end_headers()
            request.wfile.write(b"retry: 500\n\n")
            while (event := self.next_event(events)) is not None:
                request.wfile.write(f"event: {event[0]}\ndata: {json.dumps(event[1])}\n\n".encode() if event[0] else b": open\n\n")
                request.wfile.flush()
        except OSError:
            pass
        with self.lock:
            if self.clients.get(client) is events:
                del self.clients[client]
                self.tell_writers()
        request.close_connection = True

    @staticmethod
    def next_event(events):
        try:
            return events.get(timeout=0.1)
        except queue.Empty:
            return ("", None)

    def tell_writers(self):
        if self.clients and self.writer not in self.clients:
            self.writer = next(iter(self.clients))
        for client, events in self.clients.items():
            events.put(("writer", {"writer": client == self.writer, "others": len(self.clients) - 1}))

    def post(self, request):
        query = dict(urllib.parse.parse_qsl(urllib.parse.urlparse(request.path).query))
        body = json.loads(request.rfile.read(int(request.headers["Content-Length"])))
        if query.get("token") != self.token:
            request.send_error(403)
            return
        with self.lock:
            self.flying += 1
            self.most_flying = max(self.most_flying, self.flying)
        time.sleep(self.delay)
        try:
            with self.lock:
                self.flying -= 1
                self.calls.append((time.monotonic(), body))
                if body["do"] not in ("write", "export", "pose") and query.get("client") != self.writer:
                    raise Refused("Another window changes this design.")
                told = {"done": True} | getattr(self, "do_" + body["do"])(body, query.get("client"))
            self.answer(request, 200, json.dumps(told).encode())
        except Refused as refused:
            self.answer(request, 409, json.dumps({"error": str(refused)} | refused.more).encode())

    def command(self):
        return "fettle simulate small.design.json " + " ".join(f"--set {name}={value:g}mm" for name, value in self.values.items())

    def do_set(self, body, _):
        for name, value in body["values"].items():
            bounds = next((p for p in self.parameters if p["name"] == name), None)
            if bounds is None or not bounds["lower"] <= value <= bounds["upper"]:
                raise Refused(f"{name}: {value} is out of bounds.")
        return {"revision": self.set(body["values"]), "command": self.command()}

    def moved(self, source, target):
        if not source:
            raise Refused("There is nothing to undo.")
        target.append(self.values)
        self.values = source.pop()
        return {"revision": self.ask(), "command": self.command()}

    def do_undo(self, *_):
        return self.moved(self.past, self.future)

    def do_redo(self, *_):
        return self.moved(self.future, self.past)

    def do_reset(self, *_):
        return {"revision": self.set(self.file_values), "command": self.command()}

    def do_pull(self, body, _):
        name, by = body["requirement"], self.slopes.get(body["requirement"])
        if by is None or "gradient" not in self.newest:
            raise Refused("The derivatives are not known yet.")
        row = next((row for row in self.rows() if row["name"] == name), None)
        now = self.objective() if row is None else row["lower"] if row["required_lower"] is not None else row["upper"]
        ranges = {p["name"]: p["upper"] - p["lower"] for p in self.parameters}
        total = sum((by[p] * ranges[p]) ** 2 for p in ranges)
        wanted = {p["name"]: self.values[p["name"]] + by[p["name"]] * ranges[p["name"]] ** 2 / total * (body["value"] - now) for p in self.parameters}
        values = {p["name"]: min(p["upper"], max(p["lower"], wanted[p["name"]])) for p in self.parameters}
        predicted = now + sum(by[p] * (values[p] - self.values[p]) for p in ranges)
        return {"revision": self.set(values), "values": values, "predicted": predicted, "reached": values == wanted, "command": self.command()}

    def do_tune(self, *_):
        self.tuning = threading.Event()
        threading.Thread(target=self.tune, args=(self.tuning,), daemon=True).start()
        return {"command": "fettle optimise small.design.json --out out"}

    def do_stop(self, *_):
        if self.tuning is None:
            raise Refused("Nothing is tuned.")
        self.tuning.set()
        return {}

    def tune(self, stopped):
        start, best = dict(self.values), dict(self.values)
        found = {"values": best, "violation": 0.0}
        for evaluations in range(1, 1000):
            name = self.parameters[1]["name"]
            best[name] = start[name] - 0.1 * min(evaluations, 5)
            self.tell("tune", {"state": "running", "evaluations": evaluations, "objective": 5 - 0.1 * min(evaluations, 5), "message": ""} | found)
            if stopped.wait(0.05):
                break
        self.tell("tune", {"state": "ended", "evaluations": evaluations, "objective": 4.5, "message": "Stopped; the best is kept."} | found)
        self.set(best)

    def do_save(self, body, _):
        name = body["as"] or "small.design.json"
        if not name.endswith(".json"):
            raise Refused(f"{name}: a design's name ends with .design.json.")
        if body["as"] in self.files and not body.get("replace"):
            raise Refused(f"{name} is there already", exists=True)
        self.files.add(name)
        if not body["as"]:
            self.parameters = [p | {"value": self.values[p["name"]]} for p in self.parameters]
            self.ask()
        return {"file": name, "command": f"fettle simulate {name}"}

    def do_export(self, body, _):
        return {"name": f"small.{body['what']}", "base64": base64.b64encode(b"parts").decode(), "command": f"fettle export small.design.json --to small.{body['what']}"}

    def do_write(self, _, client):
        self.writer = client
        self.tell_writers()
        return {}

    # What someone does to the file.

    def edit(self, description):
        with self.lock:
            self.report = self.report | {"description": description}
            self.revision += 1
            self.newest = {"opened": self.opened()}
            self.tell("opened", self.newest["opened"])
            self.ask()

    def fault(self, errors):
        self.tell("fault", {"errors": errors})
