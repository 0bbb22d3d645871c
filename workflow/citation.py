"""Make files from pyproject.toml (`make citation`): for citing, and the environment of jobs.

The table [tool.citation] of pyproject.toml holds what [project] has no key for, such as a DOI and
a date of release. Addresses stand in [project.urls]. `snakemake --sdm conda` installs the packages
that workflow/envs/impact-damper.yaml lists, and runs the jobs with them.
"""

import json
import sys
import tomllib
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]
MADE = "# Made from pyproject.toml by `make citation`.\n"
# Key in [project.urls] -> keys in CITATION.cff and in codemeta.json.
ADDRESSES = {
    "Repository": ("repository-code", "codeRepository"),
    "Documentation": ("url", "url"),
    "Issues": (None, "issueTracker"),
}


def citation(project, cited):
    """Return the content of CITATION.cff."""
    urls = project.get("urls", {})
    return {
        "cff-version": "1.2.0",
        "message": cited["message"],
        "type": "software",
        "title": cited["title"],
        "abstract": project["description"],
        "version": project["version"],
        "license": project["license"],
        "keywords": project["keywords"],
        "authors": project["authors"],
        **{key: cited[key] for key in ("doi", "date-released") if key in cited},
        **{ADDRESSES[name][0]: urls[name] for name in urls if ADDRESSES[name][0]},
        "references": cited["references"],
    }


def codemeta(project, cited):
    """Return the content of codemeta.json."""
    urls, extras = project.get("urls", {}), project["optional-dependencies"]
    published = {"identifier": "doi", "datePublished": "date-released"}
    return {
        "@context": "https://w3id.org/codemeta/3.0",
        "@type": "SoftwareSourceCode",
        "name": project["name"],
        "description": project["description"],
        "version": project["version"],
        "license": f"https://spdx.org/licenses/{project['license']}",
        "keywords": project["keywords"],
        "author": [{"@type": "Organization", "name": each["name"]} for each in project["authors"]],
        "programmingLanguage": "Python",
        "runtimePlatform": f"Python {project['requires-python']}",
        "softwareRequirements": project["dependencies"],
        "softwareSuggestions": sorted({name for each in extras.values() for name in each}),
        **{key: cited[name] for key, name in published.items() if name in cited},
        **{ADDRESSES[name][1]: urls[name] for name in urls},
        "referencePublication": [article(each) for each in cited["references"]],
    }


def article(reference):
    """Return a reference of CITATION.cff as an article in the terms of CodeMeta."""
    issue = f"{reference['volume']}({reference['issue']})"
    pages = f"{reference['start']}-{reference['end']}"
    return {
        "@type": "ScholarlyArticle",
        "name": reference["title"],
        "author": [
            {
                "@type": "Person",
                "givenName": each["given-names"],
                "familyName": each["family-names"],
            }
            for each in reference["authors"]
        ],
        "datePublished": str(reference["year"]),
        "isPartOf": {"@type": "CreativeWork", "name": f"{reference['journal']} {issue}, {pages}"},
    }


def environment(project):
    """Return the text of a conda environment for the jobs. It does not include Snakemake."""
    packages = [*project["dependencies"], *project["optional-dependencies"]["workflow"]]
    lines = sorted(each.lower().replace(">=", " >=") for each in packages)
    lines = [each for each in lines if not each.startswith("snakemake ")]
    lines.insert(0, f"python {project['requires-python']}")
    return (
        f"{MADE}# Packages of the jobs, with the lower bounds of pyproject.toml. "
        "Snakemake is not among them.\n"
        "# Used only by `PYTHONPATH=$PWD/src snakemake --sdm conda`.\n"
        "channels: [conda-forge]\ndependencies:\n" + "".join(f"  - {each}\n" for each in lines)
    )


def files(pyproject):
    """Return a dict: name of a file -> text of the file. `pyproject` is a text."""
    table = tomllib.loads(pyproject)
    project, cited = table["project"], table["tool"]["citation"]
    plain = {"sort_keys": False, "allow_unicode": True, "width": 100}
    return {
        "CITATION.cff": MADE + yaml.safe_dump(citation(project, cited), **plain),
        "codemeta.json": json.dumps(codemeta(project, cited), indent=2) + "\n",
        "workflow/envs/impact-damper.yaml": environment(project),
    }


def main(folder):
    """Write the files into a folder."""
    for name, text in files((ROOT / "pyproject.toml").read_text()).items():
        path = Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


if __name__ == "__main__":
    main(*sys.argv[1:] or [ROOT])
