rule machines:
    input:
        code=code("machines"),
        kernels=KERNELS,
    output:
        "<results>/machines/{name}.nc",
    log:
        "<logs>/machines/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("machines"),
    message:
        "A damper for the machine {wildcards.name}"
    script:
        "../scripts/machines.py"


# One job makes the pages of all machines, because starting a job takes as long as making a page.
rule machine_pages:
    input:
        machines=data("machines"),
        code=code("machine_pages"),
        templates=[
            local(PACKAGES / "impact_damper/plot/pages/templates" / name)
            for name in ("page.html", "page.md")
        ],
    output:
        [page for page in page_files("machines") if not page.endswith("index.html")],
        [
            report(
                f"<results>/machines/{name}/index.html",
                category=CHAPTERS["machines"].TITLE,
                labels={"kind": "page", "name": name},
            )
            for name in selection.entries(config, "machines")
        ],
    log:
        "<logs>/machine_pages.log",
    conda:
        ENVIRONMENT
    params:
        names={"names": selection.entries(config, "machines")},
    message:
        "The pages of the machines"
    script:
        "../scripts/machine_pages.py"
