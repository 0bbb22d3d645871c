"""Time and memory of each stage of the pipeline, from the files that its jobs wrote.

`python -m benchmarks.stages` writes the costs of the last run in `results` into `config/README.md`.
"""

import json
import re
from pathlib import Path

import pandas as pd

from chatterjee1995.sections.registry import STAGES

# Column of a file of timings (chatterjee1995.workflow.job) -> name of the column here.
COLUMNS = {"seconds": "seconds", "cpu_seconds": "cpu_seconds", "peak_memory_mb": "memory_mb"}


def jobs(folder, since=0.0):
    """Return a row for each job under a folder of timings: stage, job and its measures.

    Files written before the time `since`, in seconds since 1970, are left out. A subfolder holds
    the jobs of a stage. A file outside the subfolders is the only job of its stage.
    """
    rows = []
    for path in sorted(folder.rglob("*.tsv")):
        if path.stat().st_mtime < since:
            continue
        stage, *rest = path.relative_to(folder).with_suffix("").parts
        values = pd.read_csv(path, sep="\t").iloc[-1]
        measures = {name: values[column] for column, name in COLUMNS.items()}
        rows.append({"stage": stage, "job": "/".join(rest) or stage} | measures)
    return pd.DataFrame(rows, columns=["stage", "job", *COLUMNS.values()])


def table(folder):
    """Return a row for each stage, the longest stage first, and a row for the total.

    Returns
    -------
    pandas.DataFrame
        Stage, jobs, wall and CPU seconds, the longest job and its wall seconds, peak memory (MB).
    """
    found = jobs(folder)
    rows = []
    for stage, of in [*found.groupby("stage"), ("total", found)]:
        if of.empty:
            continue
        longest = of.loc[of["seconds"].idxmax()]
        rows.append({
            "stage": stage, "jobs": len(of), "seconds": of["seconds"].sum(),
            "cpu_seconds": of["cpu_seconds"].sum(), "longest_job": longest["job"],
            "longest_seconds": longest["seconds"], "memory_mb": of["memory_mb"].max(),
        })  # fmt: skip
    columns = ["stage", "jobs", "seconds", "cpu_seconds"]
    columns += ["longest_job", "longest_seconds", "memory_mb"]
    made = pd.DataFrame(rows, columns=columns)
    # the total is the last row
    return made.sort_values(
        "seconds", ascending=False, key=lambda s: s.where(made["stage"] != "total", -1.0)
    ).reset_index(drop=True)


def with_costs(text, results):
    """Return the text of `config/README.md` with jobs and CPU seconds of the run in `results`.

    A row of the table names stages, and gets the costs of their jobs. A row without jobs stays. A
    stage that no row names gets a row with the message of its jobs.
    """
    costs = jobs(results / "timings").groupby("stage")["cpu_seconds"].agg(["size", "sum"])
    machine = json.loads((results / "provenance.json").read_text())["machine"]

    def row(match):
        found = costs.loc[costs.index.intersection(re.findall(r"`(\w+)`", match[1]))].sum()
        if not found["size"]:
            return match[0]
        return f"{match[1]}| {found['size']:.0f} | {found['sum']:.0f} |"

    head, rest = text.split("| stage | result | jobs | CPU seconds |\n")
    rows, end = rest.split("\n\n", 1)
    rows = re.sub(r"^(\|.*)\| \d+ \| \d+ \|$", row, rows, flags=re.MULTILINE)
    for stage in costs.index.intersection(STAGES).difference(re.findall(r"`(\w+)`", rows)):
        message = STAGES[stage].message.replace(", {name}", "")
        seconds = costs.loc[stage]
        rows += f"\n| `{stage}` | {message} | {seconds['size']:.0f} | {seconds['sum']:.0f} |"
    where = f"{machine['cores']} cores of {machine['processor']}, {costs['sum'].sum():.0f} in all"
    head = re.sub(r"\(measured on .* in all\)", f"(measured on {where})", head)
    return f"{head}| stage | result | jobs | CPU seconds |\n{rows}\n\n{end}"


if __name__ == "__main__":
    page = Path("config/README.md")
    page.write_text(with_costs(page.read_text(), Path("results")))
