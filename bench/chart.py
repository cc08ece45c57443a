#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Turns what benchmarks printed into the tables of docs/speed.md, the one of README.md, and the charts.

    chart.py record BENCH.json,... ... NAME=BENCH.json,... ... PARTS.json ...
                                    keeps results in bench/results/CPU.json, then does what write
                                    does. BENCH.json is what `mien bench --json` printed; LOD 0 is
                                    kept: the rig of the table with each storage, then other rigs.
                                    Of several files with commas between, which are runs of the
                                    same, the medians. PARTS.json is what a bench_* program printed
                                    as JSON, with repetitions
    chart.py write                  writes the tables between the marks of both documents, and the charts
    chart.py check                  fails if a document or a chart is not what the results give
"""
import html
import json
import re
import statistics
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results"
README, SPEED = ROOT / "README.md", ROOT / "docs" / "speed.md"

# Heading, activity, instances, whether all have the same active controls.
COLUMNS = [("5 %", 0.05, 1, False), ("8 %", 0.08, 1, False), ("25 %", 0.25, 1, False),
           ("50 %", 0.5, 1, False), ("100 %", 1.0, 1, False),
           ("64 instances, 25 %", 0.25, 64, False), ("64 instances, same controls, 25 %", 0.25, 64, True),
           ("512 instances, 8 %", 0.08, 512, False)]
# Those of README.md.
SUMMARY_COLUMNS = ["8 %", "25 %", "100 %", "64 instances, same controls, 25 %"]
# The same of other rigs: no CSR, as the joint matrix is a small part of them.
OTHER_COLUMNS = [("25 %", 0.25, 1, False), ("100 %", 1.0, 1, False),
                 ("64 instances, 25 %", 0.25, 64, False)]
FRAME_COLUMNS = [("frame", 1), ("frame, 64 characters", 64)]
# In the order of evaluation; what is not in a rig is left out by the program.
STAGES = [("networks", "ml_ns"), ("RBF", "rbf_ns"), ("correctives", "psd_ns"), ("joints", "joints_ns"),
          ("blend shapes", "blend_shapes_ns"), ("animated maps", "animated_maps_ns"), ("all", "evaluate_ns")]
# For bars on light and on dark pages.
COLORS = {"scalar": "#8b949e", "sse2": "#bf8700", "avx2": "#2f81f7", "avx512": "#8957e5",
           "neon": "#2da44e"}


def trimmed(run):
    """LOD 0 is what the documents show; the rest need not be kept."""
    return {key: [row for row in value if row["lod"] == 0] if key in ("csr", "rows") else value
            for key, value in run.items()}


def medians(paths):
    """One run, with the medians of several, their number, and by how much of it a time of evaluation
    differs between the fastest and the slowest, in the middle."""
    runs = [trimmed(json.loads(Path(path).read_text(encoding="utf-8"))) for path in paths]
    spreads = []
    for key in ("csr", "rows", "stages", "frames"):
        for rows in zip(*(run.get(key, []) for run in runs), strict=True):
            times = {field: [row[field] for row in rows] for field in rows[0] if field.endswith("_ns")}
            if len({json.dumps({k: v for k, v in row.items() if k not in times}) for row in rows}) > 1:
                sys.exit("chart.py: these are not runs of the same: " + ", ".join(paths))
            rows[0].update((field, statistics.median(values)) for field, values in times.items())
            if "evaluate_ns" in times and key != "stages":
                spreads.append((max(times["evaluate_ns"]) - min(times["evaluate_ns"])) /
                               rows[0]["evaluate_ns"])
    return {**runs[0], "runs": len(runs), "spread": statistics.median(spreads)}


def parts(printed):
    """Medians and coefficients of variation of a bench_* program: {benchmark: {"ns", "cv", counters}}."""
    to_ns = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
    found = {}
    for row in printed["benchmarks"]:
        part = found.setdefault(row["run_name"].replace("/real_time", ""), {})
        if row.get("aggregate_name") == "median":
            part.update((key, value) for key, value in row.items()
                        if isinstance(value, float) and not key.endswith("_time"))
            part["ns"] = row["real_time"] * to_ns[row["time_unit"]]
            part["runs"] = row["repetitions"]
        elif row.get("aggregate_name") == "cv":
            part["cv"] = row["real_time"]
    return found


def series(result):
    """[(label, instruction set, {column: (nanoseconds, times as fast as the yardstick)})]"""
    found = []
    for run in result["runs"]:
        csr = run["csr"][0]["joints_ns"]
        for key in dict.fromkeys((row["isa"], row["storage"]) for row in run["rows"]):
            values = {}
            for name, *wanted in COLUMNS:
                for row in run["rows"]:
                    if (row["isa"], row["storage"]) == key and wanted == [
                            row["activity"], row["characters"], row["shared_controls"]]:
                        values[name] = (row["evaluate_ns"], csr / row["evaluate_ns"])
            isa, storage = key
            found.append((isa if storage == "f32" else f"{isa}, 16 bits", isa, values))
    return found


def other_series(run):
    """[(label, instruction set, {column: (nanoseconds, times as fast as scalar)})]"""
    found, scalar = [], {}
    for isa in dict.fromkeys(row["isa"] for row in run["rows"]):
        times = {}
        for name, *wanted in OTHER_COLUMNS:
            for row in run["rows"]:
                if row["isa"] == isa and wanted == [
                        row["activity"], row["characters"], row["shared_controls"]]:
                    times[name] = row["evaluate_ns"]
        for name, characters in FRAME_COLUMNS:
            for row in run["frames"]:
                if row["isa"] == isa and row["characters"] == characters:
                    times[name] = row["evaluate_ns"] + row["pose_ns"] + row["deform_ns"]
        scalar = scalar or times
        found.append((isa, isa, {name: (ns, scalar[name] / ns) for name, ns in times.items()}))
    return found


def other_table(result):
    """Rigs of other kinds: bodies, networks."""
    others = result.get("others", [])
    if not others:
        return []
    names = [name for name, *_ in OTHER_COLUMNS + FRAME_COLUMNS]
    lines = ["", "Other rigs, LOD 0: all stages, and whole frames (evaluation, matrices, all meshes with "
             "skinned normals) at 25 %,", "microseconds per character; in parentheses, how many times as "
             "fast as scalar code.", ""]
    found = [(f"{run['name']}, {label}", isa, values)
             for run in others for label, isa, values in other_series(run)]
    return lines + rows_of(found, names)


def stage_rows(result):
    """[(rig, its stages)] with the best instruction set that most machines have."""
    runs = [{**result["runs"][0], "name": "large head"}] + result.get("others", [])
    return [(run["name"], row) for run in runs for row in run.get("stages", [])
            if row["isa"] in ("avx2", "neon")]


def stage_table(result):
    rows = stage_rows(result)
    if not rows:
        return []
    lines = ["", f"Their stages at 25 %, each timed by itself, {rows[0][1]['isa']}, microseconds per character.", "",
             "| |" + "|".join(f" {name} " for name, _ in STAGES) + "|", "|---|" + "---|" * len(STAGES)]
    for name, row in rows:
        cells = [f" {row[key] / 1000:.2f} " if key in row else " " for _, key in STAGES]
        many = "" if row["characters"] == 1 else f", {row['characters']} characters"
        lines.append(f"| {name}{many} |" + "|".join(cells) + "|")
    return lines


def of_runs(result):
    run = result["runs"][0]
    if run.get("runs", 1) == 1:
        return []
    spread = statistics.median(r["spread"] for r in result["runs"] + result["others"])
    return [f"Medians of {run['runs']} runs. The slowest run of a row takes {100 * spread:.0f} % longer than the "
            "fastest (median of all rows)."]


def introduction(result):
    run = result["runs"][0]
    return [f"{run['cpu']}, {run['compiler']}, one core: LOD 0 of \"{run['rig']}\", all stages, "
            "microseconds per character by the",
            "share of raw controls that are active; in parentheses, how many times as fast as the "
            "joint matrix in compressed",
            f"sparse rows ({run['csr'][0]['joints_ns'] / 1000:.0f} us), which skips no control that "
            "is zero. `mien bench` prints the same rows.",
            *of_runs(result), ""]


def rows_of(found, names):
    lines = ["| |" + "|".join(f" {name} " for name in names) + "|", "|---|" + "---|" * len(names)]
    for label, _, values in found:
        cells = [f" {values[name][0] / 1000:.1f} ({values[name][1]:.1f}x) "
                 if name in values else " " for name in names]
        lines.append(f"| {label} |" + "|".join(cells) + "|")
    return lines


def summary(result):
    """What README.md shows: one rig, 32-bit storage."""
    found = [row for row in series(result) if row[0] == row[1]]
    return introduction(result) + rows_of(found, SUMMARY_COLUMNS)


def table(result):
    return introduction(result) + rows_of(series(result), [name for name, *_ in COLUMNS]) + \
        other_table(result) + stage_table(result) + loading(result)


def loading(result):
    """How long it takes until a rig can be evaluated."""
    measured = result.get("parts", {})
    if "baked/map" not in measured:
        return []
    opened, compiled = measured["baked/map"], measured["compile/all_lods"]
    return ["", f"A baked file of \"{result['runs'][0]['rig']}\" opens in {opened['ns'] / 1000:.0f} us, the "
            f"DNA file compiles in {compiled['ns'] / 1e6:.1f} ms", f"(`bench_load`: medians of {opened['runs']} "
            f"runs, {100 * max(opened['cv'], compiled['cv']):.0f} % coefficient of variation)."]


def deformer_table(result):
    measured = result.get("parts", {})
    isas = [isa for isa in COLORS if f"frame/{isa}" in measured]
    if not isas:
        return []
    frame = measured[f"frame/{isas[0]}"]
    rows = [("skin", "positions, million per second", lambda part: f"{part['vertices'] / 1e6:.0f}"),
            ("skin_and_normals", "with skinned normals", lambda part: f"{part['vertices'] / 1e6:.0f}"),
            ("frame", f"frame: {frame['joints']:.0f} joints, {frame['deltas']:,.0f} deltas, skinning, "
             "recomputed normals; without rig evaluation", lambda part: f"{part['ns'] / 1000:.0f} us")]
    lines = [f"| head of {frame['positions']:,.0f} positions, 8 influences each |" +
             "|".join(f" {isa} " for isa in isas) + "|", "|---|" + "---|" * len(isas)]
    for name, label, text in rows:
        lines.append(f"| {label} |" + "|".join(f" {text(measured[f'{name}/{isa}'])} " for isa in isas) + "|")
    spread = max(measured[f"{name}/{isa}"]["cv"] for name, *_ in rows for isa in isas)
    run = result["runs"][0]
    return lines + ["", f"{run['cpu']}, {run['compiler']}, one core: medians of {frame['runs']} runs of "
                    f"`bench_deform`, coefficients of variation up to {100 * spread:.0f} %."]


def bars(title, rows, names, y):
    """Bars of all rows for each column, and where they end."""
    names = [name for name in names if any(name in values for _, _, values in rows)]
    most = max((v[1] for _, _, values in rows for v in values.values()), default=1.0)
    left, bar, gap, wide = 180, 14, 14, 460
    out = [f'<text x="8" y="{y}">{html.escape(title)}</text>']
    y += 16
    for name in names:
        out.append(f'<text x="8" y="{y + len(rows) * bar / 2 + 4:.0f}">{html.escape(name)}</text>')
        for label, isa, values in rows:
            if name in values:
                times = values[name][1]
                width = wide * times / most
                out.append(f'<rect x="{left}" y="{y}" width="{width:.1f}" height="{bar - 2}" '
                           f'fill="{COLORS.get(isa, "#8b949e")}"/>')
                out.append(f'<text x="{left + width + 5:.1f}" y="{y + 10}" font-size="10">'
                           f'{times:.1f} {html.escape(label)}</text>')
            y += bar
        y += gap
    return out, y


def stage_bars(rows, y):
    """A bar for each row, cut into its stages."""
    if not rows:
        return [], y
    stages = STAGES[:-1]
    shades = ["#8957e5", "#d29922", "#2da44e", "#2f81f7", "#bf3989", "#8b949e"]
    left, bar, wide = 250, 18, 460
    y += 20
    out = [f'<text x="8" y="{y}">Stages at 25 %, {rows[0][1]["isa"]}, share of the time</text>']
    x = 300
    for (name, _), shade in zip(stages, shades, strict=True):
        out.append(f'<rect x="{x}" y="{y - 9}" width="10" height="10" fill="{shade}"/>')
        out.append(f'<text x="{x + 13}" y="{y}" font-size="10">{html.escape(name)}</text>')
        x += 24 + 6 * len(name)
    y += 12
    for name, row in rows:
        many = "" if row["characters"] == 1 else f", {row['characters']} characters"
        out.append(f'<text x="8" y="{y + 12}" font-size="11">{html.escape(name + many)}</text>')
        whole, x = sum(row.get(key, 0) for _, key in stages), float(left)
        for (_, key), shade in zip(stages, shades, strict=True):
            width = wide * row.get(key, 0) / whole
            out.append(f'<rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{bar - 3}" fill="{shade}"/>')
            x += width
        out.append(f'<text x="{x + 5:.1f}" y="{y + 11}" font-size="10">{row["evaluate_ns"] / 1000:.1f} us</text>')
        y += bar
    return out, y + 14


def chart(result):
    out, y = bars("Whole evaluation, times as fast as compressed sparse rows", series(result),
                  [name for name, *_ in COLUMNS], 20)
    for run in result.get("others", []):
        more, y = bars(f"{run['name']}, times as fast as scalar code", other_series(run),
                       [name for name, *_ in OTHER_COLUMNS + FRAME_COLUMNS], y + 20)
        out += more
    more, y = stage_bars(stage_rows(result), y)
    out += more
    height = y + 4
    head = [f'<svg xmlns="http://www.w3.org/2000/svg" width="760" height="{height}" '
            f'viewBox="0 0 760 {height}" font-family="sans-serif" font-size="12">',
            "<style>text{fill:#57606a}@media(prefers-color-scheme:dark){text{fill:#adbac7}}</style>"]
    return "\n".join(head + out + ["</svg>", ""])


def results():
    return [(path, json.loads(path.read_text(encoding="utf-8")))
            for path in sorted(RESULTS.glob("*.json"))]


def speed():
    lines = []
    for path, result in results():
        picture = "../" + path.with_suffix(".svg").relative_to(ROOT).as_posix()
        lines += table(result) + ["", f"![Times as fast as compressed sparse rows]({picture})", ""]
    return lines


def of_each(lines_of):
    return [line for _, result in results() for line in lines_of(result) + [""]]


def documents():
    """{document: its text with the tables of the results}"""
    written = {}
    for file, name, lines in ((README, "bench-summary", of_each(summary)), (SPEED, "bench", speed()),
                              (SPEED, "bench-deform", of_each(deformer_table))):
        text = written.get(file) or file.read_text(encoding="utf-8")
        begin, end = f"<!-- {name}:begin -->", f"<!-- {name}:end -->"
        if text.count(begin) != 1 or text.count(end) != 1:
            sys.exit(f"chart.py: {file.name} needs {begin} and {end} once each")
        head, rest = text.split(begin)
        written[file] = head + "\n".join([begin, *lines, end]) + rest.split(end)[1]
    return written


def write_all():
    for path, result in results():
        path.with_suffix(".svg").write_text(chart(result), encoding="utf-8")
    for file, text in documents().items():
        file.write_text(text, encoding="utf-8")


def dump(value, indent=""):
    """JSON with a line for each row."""
    line = json.dumps(value, separators=(",", ":"))
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    if not any(isinstance(item, (dict, list)) for item in inner):
        return line
    deeper = indent + " "
    if isinstance(value, list):
        return "[\n" + ",\n".join(deeper + dump(item, deeper) for item in value) + "\n" + indent + "]"
    return "{\n" + ",\n".join(f"{deeper}{json.dumps(key)}: {dump(item, deeper)}"
                              for key, item in value.items()) + f"\n{indent}}}"


def record(files):
    runs, others, measured = [], [], {}
    for file in files:
        name, _, paths = file.rpartition("=")
        first = json.loads(Path(paths.split(",")[0]).read_text(encoding="utf-8"))
        if "benchmarks" in first:
            measured.update(parts(first))
        else:
            run = medians(paths.split(","))
            (others if name else runs).append({"name": name, **run} if name else run)
    if not runs:
        sys.exit(__doc__)
    name = re.sub(r"[^a-z0-9]+", "-", runs[0]["cpu"].lower()).strip("-") or "unknown"
    RESULTS.mkdir(exist_ok=True)
    text = dump({"runs": runs, "others": others, "parts": measured}) + "\n"
    (RESULTS / f"{name}.json").write_text(text, encoding="utf-8")
    write_all()
    print(f"wrote bench/results/{name}.json, its chart, docs/speed.md and README.md")


def check():
    wrong = [file.name for file, text in documents().items() if file.read_text(encoding="utf-8") != text]
    for path, result in results():
        picture = path.with_suffix(".svg")
        if not picture.exists() or picture.read_text(encoding="utf-8") != chart(result):
            wrong.append(picture.name)
    if not results():
        wrong.append("bench/results, which is empty")
    if wrong:
        sys.exit("chart.py: not what the results give: " + ", ".join(wrong) +
                 "; run bench/chart.py write")


def main(arguments):
    if len(arguments) > 1 and arguments[0] == "record":
        record(arguments[1:])
    elif arguments == ["write"]:
        write_all()
    elif arguments == ["check"]:
        check()
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main(sys.argv[1:])
