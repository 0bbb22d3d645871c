rule figures:
    input:
        [figure_files(chapter) for chapter in PAPER],


rule tables:
    input:
        [table_files(chapter) for chapter in PAPER],


# One job draws a whole chapter, because starting a job takes longer than drawing a figure.
for chapter in filter(chapter_files, CHAPTERS):

    rule:
        name:
            f"chapter_{chapter}"
        input:
            **{
                stage: data(stage, names)
                for stage, names in selection.chapter_data(settings, chapter).items()
            },
            code=code("chapter", *selection.chapter_modules(settings, chapter)),
        output:
            chapter_files(chapter),
        log:
            f"<logs>/chapters/{chapter}.log",
        conda:
            ENVIRONMENT
        params:
            **{
                key: {key: value}
                for key, value in selection.chapter_values(settings, chapter).items()
            },
        message:
            f"Figures and tables of the chapter {chapter}"
        script:
            "../scripts/chapter.py"


# One job makes the pages of all machines, because starting a job takes as long as making a page.
rule machine_pages:
    input:
        machines=data("machines"),
        code=code("machine_pages"),
    output:
        [
            report(
                f"<results>/machines/{name}/index.html",
                category=CHAPTERS["machines"],
                labels={"kind": "page", "name": name},
            )
            for name in selection.entries(settings, "machines")
        ],
    log:
        "<logs>/machine_pages.log",
    conda:
        ENVIRONMENT
    params:
        names={"names": selection.entries(settings, "machines")},
    message:
        "The pages of the machines"
    script:
        "../scripts/machine_pages.py"
