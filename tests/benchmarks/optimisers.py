#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Do the optimisers find optima, and at what price? Prints JSON lines, a summary last.

  optimisers.py starts DESIGN [--n 10] [--lists 1,2,3]        random starts: how many end optimal, at what, after how many simulations
  optimisers.py table DESIGN [--seeds 0,1,2,3,4] [--budget N]   six optimisers: simulations and CPU seconds to come within 0.1% of the
                                                              best feasible design that any of them found
  optimisers.py mutations DESIGN RESULT [--n 50] [--seed 1]   one parameter of a converged design moved by up to 5% of its range and
                                                              held there, the rest tuned again: is any of them better by 0.1%?
  optimisers.py bank [--copies 5]                             writes bank.design.json and bank.scene.json here: examples/follower so
                                                              many times side by side, 6 parameters each
Simulations are counted from history.jsonl: smoother models, noise and probes included. Uses build/release/bin/fettle.
"""
import argparse
import json
import os
import re
import random
import statistics
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
PROGRAM = os.path.join(ROOT, "build/release/bin/fettle")
WITHIN = 0.001  # of the best value
OPTIMISERS = ("sqp", "ipopt", "mma", "ccsaq", "slsqp", "cobyla")


def nearly(best, share=WITHIN):
    """The largest value that counts as the best one; objectives may be negative."""
    return best + share * abs(best)


def optimise(design, out, *options):
    """The answer of one run; its history lies in `out`."""
    command = [PROGRAM, "optimise", design, "--out", out, "--quiet", "--json", *options]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode > 2:
        sys.exit(f"{' '.join(command)}\n{run.stdout}{run.stderr}")
    return json.loads(run.stdout)


def history(out):
    with open(os.path.join(out, "history.jsonl")) as lines:
        return [json.loads(line) for line in lines][1:]


def first_within(entries, value):
    """How many simulations, and CPU seconds, until the design's own model met all at no more than `value`; None: never."""
    seconds = 0
    for number, entry in enumerate(entries, 1):
        seconds += entry["forward_seconds"] + entry["backward_seconds"]
        own = "model" not in entry
        if own and entry["usable"] and entry["violation"] <= 0 and entry["objective"] <= value:
            return number, seconds
    return None


def copied(design, folder, change):
    """A copy of the design elsewhere, changed; it finds its scene."""
    with open(design) as file:
        text = json.load(file)
    text["scene"] = os.path.abspath(os.path.join(os.path.dirname(design), text["scene"]))
    change(text)
    path = os.path.join(folder, "changed.design.json")
    with open(path, "w") as file:
        json.dump(text, file)
    return path


def starts(arguments, folder):
    rows = []
    for listed in arguments.lists.split(","):
        out = os.path.join(folder, listed)
        answer = optimise(arguments.design, out, "--starts", str(arguments.n + 1), "--seed", listed)
        for row in answer["starts"][1:]:
            rows.append({key: row[key] for key in ("seed", "status", "objective", "evaluations", "limited_by")})
            print(json.dumps(rows[-1]), flush=True)
    feasible = [row["objective"] for row in rows if row["status"] in ("optimal", "feasible")]
    best = min(feasible, default=None)
    return {
        "starts": len(rows),
        "within 0.1% of the best": sum(value <= nearly(best) for value in feasible),
        "within 0.5% of the best": sum(value <= nearly(best, 0.005) for value in feasible),
        "optimal": sum(row["status"] == "optimal" for row in rows),
        "optimal, and above the best by more than 0.1%": [r for r in rows if r["status"] == "optimal" and r["objective"] > nearly(best)],
        "best": best,
        "worst feasible": max(feasible, default=None),
        "median simulations": statistics.median(row["evaluations"] for row in rows),
    }


def table(arguments, folder):
    design = arguments.design
    if arguments.budget:
        design = copied(design, folder, lambda d: d.setdefault("optimiser", {}).update(max_evaluations=arguments.budget))
    runs = []
    for optimiser in OPTIMISERS:
        for seed in arguments.seeds.split(","):
            out = os.path.join(folder, f"{optimiser}-{seed}")
            answer = optimise(design, out, "--optimiser", optimiser, "--seed", seed)
            runs.append((optimiser, seed, answer, history(out)))
            print(json.dumps({"optimiser": optimiser, "seed": seed, **{k: answer[k] for k in ("status", "objective", "evaluations")}}), flush=True)
    best = min((a["objective"] for _, _, a, _ in runs if a["status"] in ("optimal", "feasible")), default=None)
    summary = {"best": best}
    for name in OPTIMISERS:
        summary[name] = {}
        for optimiser, seed, answer, entries in runs:
            if optimiser != name:
                continue
            found = first_within(entries, nearly(best)) if best is not None else None
            seconds = sum(e["forward_seconds"] + e["backward_seconds"] for e in entries)
            summary[name][seed] = {
                "status": answer["status"], "objective": answer["objective"], "simulations": len(entries), "seconds": round(seconds, 1),
                "simulations to 0.1%": found and found[0], "seconds to 0.1%": found and round(found[1], 1)}
    return summary


def mutations(arguments, folder):
    with open(arguments.result) as file:
        converged = json.load(file)
    rng = random.Random(arguments.seed)
    with open(arguments.design) as file:
        parameters = json.load(file)["parameters"]
    better = []
    for number in range(arguments.n):
        moved = parameters[number % len(parameters)]
        span = moved["upper"] - moved["lower"]
        # The first two rounds: the whole 5%, down and up; then anything in between.
        whole = -0.05 if number < len(parameters) else 0.05
        share = whole if number < 2 * len(parameters) else rng.uniform(-0.05, 0.05)
        value = converged["parameters"][moved["name"]] + share * span
        if not moved["lower"] <= value <= moved["upper"]:
            value = converged["parameters"][moved["name"]] - share * span

        def change(design):
            for parameter in design["parameters"]:
                parameter["value"] = converged["parameters"][parameter["name"]]
                if parameter["name"] == moved["name"]:
                    parameter.update(value=value, lower=value - 1e-6 * span, upper=value + 1e-6 * span)

        answer = optimise(copied(arguments.design, folder, change), os.path.join(folder, f"mutation-{number}"))
        row = {"parameter": moved["name"], "moved_by": value - converged["parameters"][moved["name"]],
               **{key: answer[key] for key in ("status", "objective", "evaluations")}}
        print(json.dumps(row), flush=True)
        if answer["status"] in ("optimal", "feasible") and answer["objective"] < converged["objective"] - WITHIN * abs(converged["objective"]):
            better.append(row)
    return {"tries": arguments.n, "converged": converged["objective"], "better by more than 0.1%": better}


def bank(arguments, _):
    folder = os.path.join(ROOT, "examples/follower")
    with open(os.path.join(folder, "follower.scene.json")) as file:
        scene = json.load(file)
    with open(os.path.join(folder, "follower.design.json")) as file:
        design = json.load(file)
    bodies, scene["bodies"] = scene["bodies"], []
    parameters, design["parameters"] = design["parameters"], []
    constraints, design["constraints"] = design["constraints"], []
    objective, design["objective"] = design["objective"], []
    variables, scene["variables"] = scene["variables"], {}
    for copy in range(arguments.copies):
        rename = lambda name: f"{name}_{copy}"
        names = "|".join(re.escape(name) for name in variables)
        renamed = lambda value: json.loads(re.sub(rf'(?<![\w"])({names})(?!\w)', rf"\1_{copy}", json.dumps(value)))
        for name, value in variables.items():
            scene["variables"][rename(name)] = renamed(value)
        for body in renamed(bodies):
            body["name"] = rename(body["name"])
            body["shape"]["part"] = os.path.join(folder, body["shape"]["part"])
            position = body.get("position", [0, 0, 0])
            body["position"] = [position[0] + 60 * copy, *position[1:]]
            scene["bodies"].append(body)
        for parameter in json.loads(json.dumps(parameters)):
            parameter["name"] = rename(parameter["name"])
            design["parameters"].append(parameter)
        rise = 8 + 0.2 * copy  # no two alike
        for term in json.loads(json.dumps(constraints + objective)):
            for key in ("a", "b", "body"):
                if key in term:
                    term[key] = rename(term[key])
            if "bodies" in term:
                term["bodies"] = [rename(name) for name in term["bodies"]]
            if term["type"] == "stroke":
                term.update(lower=rise - 0.02, upper=rise + 0.02)
            (design["objective"] if "weight" in term else design["constraints"]).append(term)
    scene["description"] = design["description"] = f"{arguments.copies} followers side by side"
    design["scene"] = "bank.scene.json"
    with open(os.path.join(os.getcwd(), "bank.scene.json"), "w") as file:
        json.dump(scene, file, indent=1)
    with open(os.path.join(os.getcwd(), "bank.design.json"), "w") as file:
        json.dump(design, file, indent=1)
    return {"written": ["bank.scene.json", "bank.design.json"], "parameters": len(design["parameters"])}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("starts")
    command.add_argument("design")
    command.add_argument("--n", type=int, default=10)
    command.add_argument("--lists", default="1,2,3")
    command = commands.add_parser("table")
    command.add_argument("design")
    command.add_argument("--seeds", default="0,1,2,3,4")
    command.add_argument("--budget", type=int)
    command = commands.add_parser("mutations")
    command.add_argument("design")
    command.add_argument("result")
    command.add_argument("--n", type=int, default=50)
    command.add_argument("--seed", type=int, default=1)
    command = commands.add_parser("bank")
    command.add_argument("--copies", type=int, default=5)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        print(json.dumps(globals()[arguments.command](arguments, folder), indent=1))


if __name__ == "__main__":
    main()
