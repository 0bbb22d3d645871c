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


rule machine_pages:
    input:
        **data_by_stage({"machines": ["{name}"]}),
        code=code("machine_pages"),
        templates=[local(PACKAGE / "pages/templates" / name) for name in ("page.html", "page.md")],
    output:
        report(
            "<results>/machines/{name}/index.html",
            category=CHAPTERS["machines"].TITLE,
            labels={"kind": "page", "name": "{name}"},
        ),
        "<results>/machines/{name}/report.md",
        expand("<results>/machines/{{name}}/{figure}.png", figure=STAGES["machines"].page),
    log:
        "<logs>/machine_pages/{name}.log",
    conda:
        ENVIRONMENT
    params:
        name=lambda wildcards: {"name": wildcards.name},
    message:
        "The page of the machine {wildcards.name}"
    script:
        "../scripts/machine_pages.py"
