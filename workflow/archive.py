"""Archive of a run, with a Workflow Run RO-Crate: `python workflow/archive.py write|check FILE`.

The archive holds the results and all that computed them. Its `ro-crate-metadata.json` follows the
Provenance Run Crate 0.5. It lists each file with its digest, and each job with its function,
parameters, inputs, outputs, times and memory, from the records of Snakemake and the job's timing.
"""

import argparse
import ast
import base64
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from datetime import UTC, datetime
from mimetypes import guess_type
from pathlib import Path
from urllib.parse import quote, unquote

METADATA = "ro-crate-metadata.json"
CONTEXT = [
    "https://w3id.org/ro/crate/1.1/context",
    "https://w3id.org/ro/terms/workflow-run/context",
]
LANGUAGE = "https://w3id.org/workflowhub/workflow-ro-crate#snakemake"
CRATE = "https://w3id.org/ro/crate/1.1"
PROFILES = {
    "https://w3id.org/ro/wfrun/process/0.5": "Process Run Crate",
    "https://w3id.org/ro/wfrun/workflow/0.5": "Workflow Run Crate",
    "https://w3id.org/ro/wfrun/provenance/0.5": "Provenance Run Crate",
    "https://w3id.org/workflowhub/workflow-ro-crate/1.0": "Workflow RO-Crate",
}
# What a rerun needs beside the results: files, and folders with all their files.
PROJECT = "CITATION.cff CONTRIBUTING.md LICENSE Makefile README.md Snakefile codemeta.json".split()
PROJECT += "config profiles pyproject.toml requirements.lock src workflow".split()
LEFT_OUT = "__pycache__", ".egg-info", ".part-"
NETCDF = "application/x-netcdf"


def entity(name, kind, /, **properties):
    """Return an entity of the crate, without the properties that are None or empty."""
    given = {key: value for key, value in properties.items() if value not in (None, [])}
    return {"@id": encoded(name), "@type": kind} | given


def encoded(name):
    """Return the identifier of an entity: paths in a crate are URIs."""
    return quote(name, safe="/#:?=")


def links(names):
    """Return references to entities."""
    return [{"@id": encoded(name)} for name in names]


def sha256(path):
    """Return the digest of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def stamp(seconds):
    """Return a time of Snakemake as text."""
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="milliseconds")


def listed(root, results):
    """Return the paths of all files of the archive, relative to the root."""
    tops = [root / name for name in (*PROJECT, results) if (root / name).exists()]
    paths = [path for top in tops for path in (top.rglob("*") if top.is_dir() else [top])]
    names = [path.relative_to(root).as_posix() for path in paths if path.is_file()]
    return sorted(name for name in names if not any(part in name for part in LEFT_OUT))


def jobs_of(root, files):
    """Return the record of each job by the name of its log, with `output` and `values`."""
    folder, jobs = root / ".snakemake/metadata", {}
    for path in sorted(each for each in folder.rglob("*") if each.is_file()):
        # Snakemake names a record by its output in base64, long names in folders that begin with @.
        name = path.relative_to(folder).as_posix().replace("/", "").replace("@", "")
        output = base64.urlsafe_b64decode(name + "=" * (-len(name) % 4)).decode()
        record = json.loads(path.read_text())
        if output in files and record["log"]:
            job = record["log"][0].split("logs/", 1)[-1].removesuffix(".log")
            jobs.setdefault(job, record | {"output": []})["output"].append(output)
    for job in jobs.values():
        job["values"] = {}
        for each in job["params"]:
            job["values"] |= ast.literal_eval(each)
        job["script"] = "workflow/" + ast.literal_eval(job["code"].strip()).removeprefix("../")
    return jobs


def files_of(root, paths, jobs):
    """Yield the entity of each file; figures and tables have their captions."""
    rules = {output: job["rule"] for job in jobs.values() for output in job["output"]}
    for path in paths:
        caption = (root / path).with_suffix(".rst")
        shown = Path(path).parent.name in ("figures", "tables") and caption.exists()
        kind = NETCDF if path.endswith(".nc") else guess_type(path)[0] or "text/plain"
        parameter = f"{rules[path]}/output" if path in rules else None
        yield entity(
            path,
            "File",
            name=path,
            contentSize=str((root / path).stat().st_size),
            sha256=sha256(root / path),
            encodingFormat=kind,
            description=caption.read_text().strip() if shown else None,
            exampleOfWork=links([f"#{parameter}"]) if parameter else None,
        )


def usage(root, name, job):
    """Return time and memory of a job as entities."""
    path = root / Path(job["log"][0].replace("logs/", "timings/", 1)).with_suffix(".tsv")
    keys, numbers = map(str.split, path.read_text().splitlines()) if path.exists() else ([], [])
    return [
        entity(f"#{name}/{key}", "PropertyValue", name=key, propertyID=f"#{key}", value=number)
        for key, number in zip(keys, numbers, strict=True)
    ]


def actions(root, jobs):
    """Yield the entities of each job: parameters, time and memory, its action and its start."""
    for name, job in jobs.items():
        given = [
            entity(
                f"#{name}/{key}",
                "PropertyValue",
                name=key,
                value=json.dumps(value),
                exampleOfWork=links([f"#{job['rule']}/{key}"]),
            )
            for key, value in job["values"].items()
        ]
        used = usage(root, name, job)
        yield from (*given, *used)
        yield entity(
            f"#{name}",
            "CreateAction",
            name=f"job {name}",
            instrument=links([f"#{job['rule']}/tool"]),
            object=links(job["input"]) + [{"@id": each["@id"]} for each in given],
            result=links(job["output"]),
            startTime=stamp(job["starttime"]),
            endTime=stamp(job["endtime"]),
            actionStatus="http://schema.org/CompletedActionStatus",
            resourceUsage=[{"@id": each["@id"]} for each in used],
        )
        step = links([f"#{job['rule']}"])
        started = links([f"#{name}"])
        yield entity(
            f"#{name}/start", "ControlAction", name=f"start {name}", instrument=step, object=started
        )


def rules_of(jobs, version):
    """Yield the step of each rule, its tool (the function that its jobs call), and parameters."""
    for rule in sorted({job["rule"] for job in jobs.values()}):
        same = [job for job in jobs.values() if job["rule"] == rule]
        first = same[0]
        keys = [f"#{rule}/{key}" for key in sorted({key for job in same for key in job["values"]})]
        yield entity(f"#{rule}", "HowToStep", name=rule, workExample=links([f"#{rule}/tool"]))
        yield entity(
            f"#{rule}/tool",
            "SoftwareApplication",
            name=first["values"].get("function", first["script"]),
            softwareVersion=version,
            mainEntity=links([first["script"]]),
            input=links(keys),
            output=links([f"#{rule}/output"]),
        )
        for each in keys:
            name = each.rpartition("/")[2]
            yield entity(each, "FormalParameter", name=name, additionalType="PropertyValue")
        yield entity(f"#{rule}/output", "FormalParameter", name=rule, additionalType="File")


def top(root, results, paths, jobs, project):
    """Yield the entities of the crate, of the workflow, of its run, and of Snakemake."""
    outputs = sorted(output for job in jobs.values() for output in job["output"])
    begin, end = (
        stamp(choose(job[key] for job in jobs.values()))
        for choose, key in ((min, "starttime"), (max, "endtime"))
    )
    rules = sorted({job["rule"] for job in jobs.values()})
    versions = json.loads((root / results / "provenance.json").read_text())["versions"]
    profiles, terms = links(PROFILES), f"https://spdx.org/licenses/{project['license']}"
    about = {"about": {"@id": "./"}, "conformsTo": [{"@id": CRATE}, profiles[-1]]}
    yield entity(METADATA, "CreativeWork", **about)
    yield entity(
        "./",
        "Dataset",
        name=f"Results of {project['name']} {project['version']}",
        description=project["description"],
        datePublished=end,
        license={"@id": terms},
        author=links(["#authors"]),
        conformsTo=profiles,
        mainEntity={"@id": "Snakefile"},
        mentions=links(["#run", "#engine"]),
        hasPart=links(paths),
    )
    yield entity(terms, "CreativeWork", name=project["license"])
    yield entity("#authors", "Organization", name=project["authors"][0]["name"])
    for address, name in PROFILES.items():
        yield entity(address, "CreativeWork", name=name, version=address.rpartition("/")[2])
    yield entity(
        "Snakefile",
        ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
        name="Snakefile",
        sha256=sha256(root / "Snakefile"),
        version=project["version"],
        license={"@id": terms},
        creator=links(["#authors"]),
        programmingLanguage=links([LANGUAGE])[0],
        hasPart=links(f"#{rule}/tool" for rule in rules),
        step=links(f"#{rule}" for rule in rules),
        output=links(f"#{rule}/output" for rule in rules),
    )
    snakemake = {"name": "Snakemake", "url": {"@id": "https://snakemake.readthedocs.io"}}
    yield entity(LANGUAGE, "ComputerLanguage", version=versions["snakemake"], **snakemake)
    yield entity(
        "#snakemake", "SoftwareApplication", softwareVersion=versions["snakemake"], **snakemake
    )
    yield entity(
        "#run",
        "CreateAction",
        name="run of the workflow",
        instrument=links(["Snakefile"]),
        object=links(path for path in paths if path not in outputs),
        result=links(outputs),
        startTime=begin,
        endTime=end,
    )
    yield entity(
        "#engine",
        "OrganizeAction",
        name="run of Snakemake",
        instrument=links(["#snakemake"]),
        object=links(f"#{name}/start" for name in jobs),
        result=links(["#run"]),
    )


def write(root, archive, results):
    """Write the archive of the results of the project in a folder."""
    paths = listed(root, results)
    jobs = jobs_of(root, set(paths))
    if not jobs:
        sys.exit(f"{root / '.snakemake'} has no record of a job: run `make reproduce` first.")
    lost = {path for job in jobs.values() for path in job["input"]}.difference(paths)
    if lost:
        sys.exit(f"Inputs of jobs are not in the archive: {', '.join(sorted(lost))}.")
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    files = [each for each in files_of(root, paths, jobs) if each["@id"] != "Snakefile"]
    graph = [
        *top(root, results, paths, jobs, project),
        *rules_of(jobs, project["version"]),
        *actions(root, jobs),
        *files,
    ]
    metadata = json.dumps({"@context": CONTEXT, "@graph": graph}, indent=1)
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(METADATA, metadata)
        for path in paths:
            file.write(root / path, path)
    print(f"{archive}: {len(paths)} files, {len(jobs)} jobs")


def check(archive, job):
    """Compare all digests of an archive, and run one of its jobs again, to the same bytes."""
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(archive) as file:
            file.extractall(folder)
        root = Path(folder)
        graph = json.loads((root / METADATA).read_text())["@graph"]
        digests = {unquote(each["@id"]): each["sha256"] for each in graph if "sha256" in each}
        present = {each.relative_to(root).as_posix() for each in root.rglob("*") if each.is_file()}
        wrong = digests.keys() ^ (present - {METADATA})
        wrong |= {path for path in digests.keys() & present if sha256(root / path) != digests[path]}
        if wrong:
            sys.exit(f"{archive}: damaged, lacking or not listed: {', '.join(sorted(wrong))}.")
        print(f"{archive}: {len(digests)} files have the digests of the crate")
        rerun(root, {each["@id"]: each for each in graph}, job)


def cheapest(entities):
    """Return the job with the shortest time among those that read no dataset and write one."""

    def has_datasets(action, key):
        return any(each["@id"].endswith(".nc") for each in action[key])

    def seconds(action):
        return float(entities[f"{action['@id']}/seconds"]["value"])

    jobs = [each for each in entities.values() if "resourceUsage" in each]
    alone = [
        each for each in jobs if has_datasets(each, "result") and not has_datasets(each, "object")
    ]
    return min(alone, key=seconds)["@id"].removeprefix("#")


def rerun(root, entities, job):
    """Delete the outputs of a job, run it from the files of the archive, and compare digests."""
    job = job or cheapest(entities)
    outputs = [unquote(each["@id"]) for each in entities[f"#{job}"]["result"]]
    for path in outputs:
        (root / path).unlink()
    command = [sys.executable, "-m", "snakemake", "--cores", "1", "--rerun-triggers", "input"]
    environment = os.environ | {"PYTHONPATH": str(root / "src")}
    subprocess.run([*command, "--", *outputs], cwd=root, env=environment, check=True)
    other = [path for path in outputs if sha256(root / path) != entities[encoded(path)]["sha256"]]
    if other:
        sys.exit(f"The job {job} run again writes other bytes: {', '.join(other)}.")
    print(f"The job {job} run again writes the same bytes: {', '.join(outputs)}")


def main():
    """Read the arguments, and write or check an archive."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["write", "check"])
    parser.add_argument("archive", type=Path)
    parser.add_argument("--results", default="results", help="folder of the results")
    parser.add_argument("--job", help="job to run again; otherwise the shortest one")
    given = parser.parse_args()
    if given.what == "write":
        write(Path.cwd(), given.archive, given.results)
    else:
        check(given.archive, given.job)


if __name__ == "__main__":
    main()
