"""Metadata of an archived run: an RO-Crate by the profile Provenance Run Crate, version 0.5.

https://www.researchobject.org/workflow-run-crate/profiles/provenance_run_crate lists the contents:
files, rules as steps of the workflow, and each job with its function, parameters, inputs,
outputs and times. The data come from the folders `.snakemake/metadata` and `timings`.
"""

import ast
import base64
import hashlib
import json
import re
import tomllib
from datetime import UTC, datetime
from mimetypes import guess_type
from pathlib import Path
from urllib.parse import quote

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
NETCDF = "application/x-netcdf"
UNITS = {"seconds": "SEC", "cpu_seconds": "SEC", "peak_memory_mb": "MegaBYTE"}


def entity(name, kind, /, **properties):
    """Return an entity of the crate. Properties None and [] are left out, and [x] becomes x."""
    given = {key: value for key, value in properties.items() if value not in (None, [])}
    for key, value in given.items():
        if isinstance(value, list) and len(value) == 1:
            given[key] = value[0]
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
    """Return a time, in seconds since 1970, as text."""
    return datetime.fromtimestamp(seconds, UTC).isoformat(timespec="milliseconds")


def jobs_of(root, files):
    """Return Snakemake's record of each job, with outputs and parameters, keyed by log file."""
    folder, jobs = root / ".snakemake/metadata", {}
    for path in sorted(each for each in folder.rglob("*") if each.is_file()):
        # The path of a record is the name of an output in base64, split into folders if it is long.
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
        job["script"] = "workflow/" + re.search(r"scripts/\w+\.py", job["code"])[0]
        job["calls"] = job["values"].get("function", job["script"])
    return jobs


def files_of(root, paths, jobs):
    """Yield the entity of each file. Figures and tables have their caption as description."""
    rules = {output: job["rule"] for job in jobs.values() for output in job["output"]}
    for path in paths:
        caption = (root / path).with_suffix(".rst")
        shown = Path(path).parent.name in ("figures", "tables") and caption.exists()
        kind = NETCDF if path.endswith(".nc") else guess_type(path)[0] or "text/plain"
        parameter = f"rule/{rules[path]}/output" if path in rules else None
        yield entity(
            path,
            "File",
            name=path,
            contentSize=str((root / path).stat().st_size),
            sha256=sha256(root / path),
            encodingFormat=kind,
            description=caption.read_text().strip() if shown else None,
            about={"@id": "./"} if path == "README.md" else None,
            exampleOfWork=links([f"#{parameter}"]) if parameter else None,
        )


def usage(root, name, job):
    """Return time and memory of a job as entities."""
    path = root / Path(job["log"][0].replace("logs/", "timings/", 1)).with_suffix(".tsv")
    keys, numbers = map(str.split, path.read_text().splitlines()) if path.exists() else ([], [])
    return [
        entity(
            f"#{name}/{key}",
            "PropertyValue",
            name=key,
            propertyID=f"#{key}",
            value=number,
            unitCode=f"https://qudt.org/vocab/unit/{UNITS[key]}",
        )
        for key, number in zip(keys, numbers, strict=True)
    ]


def actions(root, jobs):
    """Yield the entities of each job: parameters, time and memory, the run and its start."""
    for name, job in jobs.items():
        given = [
            entity(
                f"#{name}/{key}",
                "PropertyValue",
                name=key,
                value=json.dumps(value),
                exampleOfWork=links([f"#rule/{job['rule']}/{key}"]),
            )
            for key, value in job["values"].items()
        ]
        used = usage(root, name, job)
        yield from (*given, *used)
        yield entity(
            f"#{name}",
            "CreateAction",
            name=f"job {name}",
            description=f"Snakemake ran the rule {job['rule']}, which calls {job['calls']}.",
            instrument=links([f"#rule/{job['rule']}/tool"]),
            object=links(job["input"]) + [{"@id": each["@id"]} for each in given],
            result=links(job["output"]),
            startTime=stamp(job["starttime"]),
            endTime=stamp(job["endtime"]),
            actionStatus="http://schema.org/CompletedActionStatus",
            resourceUsage=[{"@id": each["@id"]} for each in used],
        )
        step = links([f"#rule/{job['rule']}"])
        started = links([f"#{name}"])
        yield entity(
            f"#{name}/start", "ControlAction", name=f"start {name}", instrument=step, object=started
        )


def rules_of(jobs, version):
    """Yield for each rule a step, a tool (the function that the jobs call), and parameters."""
    for rule in sorted({job["rule"] for job in jobs.values()}):
        same = [job for job in jobs.values() if job["rule"] == rule]
        first = same[0]
        keys = [
            f"#rule/{rule}/{key}" for key in sorted({key for job in same for key in job["values"]})
        ]
        yield entity(
            f"#rule/{rule}", "HowToStep", name=rule, workExample=links([f"#rule/{rule}/tool"])
        )
        yield entity(
            f"#rule/{rule}/tool",
            "SoftwareApplication",
            name=first["calls"],
            softwareVersion=version,
            mainEntity=links([first["script"]]),
            input=links(keys),
            output=links([f"#rule/{rule}/output"]),
        )
        for each in keys:
            name = each.rpartition("/")[2]
            yield entity(each, "FormalParameter", name=name, additionalType="PropertyValue")
        yield entity(f"#rule/{rule}/output", "FormalParameter", name=rule, additionalType="File")


def workflow_of(project, rules, digest, version):
    """Yield entities on the workflow, its language, its license and the profiles of the crate."""
    terms = f"https://spdx.org/licenses/{project['license']}"
    snakemake = {"name": "Snakemake", "url": {"@id": "https://snakemake.readthedocs.io"}}
    yield entity(
        "Snakefile",
        ["File", "SoftwareSourceCode", "ComputationalWorkflow", "HowTo"],
        name="Snakefile",
        sha256=digest,
        version=project["version"],
        license={"@id": terms},
        creator=links(["#authors"]),
        programmingLanguage={"@id": LANGUAGE},
        hasPart=links(f"#rule/{rule}/tool" for rule in rules),
        step=links(f"#rule/{rule}" for rule in rules),
        output=links(f"#rule/{rule}/output" for rule in rules),
    )
    yield entity(LANGUAGE, "ComputerLanguage", version=version, **snakemake)
    yield entity("#snakemake", "SoftwareApplication", softwareVersion=version, **snakemake)
    yield entity(terms, "CreativeWork", name=project["license"])
    yield entity("#authors", "Organization", name=project["authors"][0]["name"])
    for address, name in PROFILES.items():
        yield entity(address, "CreativeWork", name=name, version=address.rpartition("/")[2])


def run_of(project, paths, jobs):
    """Yield entities on the crate itself, the run of the workflow, and the run of Snakemake."""
    outputs = {output for job in jobs.values() for output in job["output"]}
    begin = stamp(min(job["starttime"] for job in jobs.values()))
    end = stamp(max(job["endtime"] for job in jobs.values()))
    profiles = links(PROFILES)
    conforming = [{"@id": CRATE}, profiles[-1]]
    yield entity(METADATA, "CreativeWork", about={"@id": "./"}, conformsTo=conforming)
    yield entity(
        "./",
        "Dataset",
        name=f"Results of {project['name']} {project['version']}",
        description=project["description"],
        datePublished=end,
        license={"@id": f"https://spdx.org/licenses/{project['license']}"},
        author=links(["#authors"]),
        conformsTo=profiles,
        mainEntity={"@id": "Snakefile"},
        mentions=links(["#run", "#engine", *(f"#{name}" for name in jobs)]),
        hasPart=links(paths),
    )
    yield entity(
        "#run",
        "CreateAction",
        name="run of the workflow",
        description="Snakemake ran the jobs of the workflow whose outputs were lacking or old.",
        instrument=links(["Snakefile"]),
        object=links(path for path in paths if path not in outputs),
        result=links(sorted(outputs)),
        startTime=begin,
        endTime=end,
    )
    yield entity(
        "#engine",
        "OrganizeAction",
        name="run of Snakemake",
        description="Snakemake planned and started the jobs.",
        instrument=links(["#snakemake"]),
        object=links(f"#{name}/start" for name in jobs),
        result=links(["#run"]),
    )


def crate(root, results, paths):
    """Return the metadata of a crate with the files `paths`, and the number of jobs."""
    jobs = jobs_of(root, set(paths))
    read, made = (
        {path for job in jobs.values() for path in job[key]} for key in ("input", "output")
    )
    unknown = [path for path in paths if path.endswith(".nc") and path not in made]
    if unknown or not jobs:
        raise ValueError(
            f"{root / '.snakemake'} lacks the jobs that made {len(unknown)} datasets, such as "
            f"{unknown[:1]}: they come from another run or from a cache; delete them and run again"
        )
    if lost := read.difference(paths):
        raise ValueError(f"inputs of jobs are not in the archive: {', '.join(sorted(lost))}")
    project = tomllib.loads((root / "pyproject.toml").read_text())["project"]
    rules = sorted({job["rule"] for job in jobs.values()})
    version = json.loads((root / results / "provenance.json").read_text())["versions"]["snakemake"]
    graph = [
        *run_of(project, paths, jobs),
        *workflow_of(project, rules, sha256(root / "Snakefile"), version),
        *rules_of(jobs, project["version"]),
        *actions(root, jobs),
        *files_of(root, [path for path in paths if path != "Snakefile"], jobs),
    ]
    return {"@context": CONTEXT, "@graph": graph}, len(jobs)
