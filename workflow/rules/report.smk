rule figures:
    input:
        [figure_files(chapter) for chapter in PAPER],


rule tables:
    input:
        [table_files(chapter) for chapter in PAPER],


# One job makes all figures and tables of a chapter, because starting a job takes longer than
# drawing a figure.
for chapter in filter(chapter_files, CHAPTERS):

    rule:
        name:
            f"chapter_{chapter}"
        input:
            **data_by_stage(selection.chapter_data(config, chapter)),
            code=code("chapter", *selection.chapter_modules(config, chapter)),
        output:
            chapter_files(chapter),
        log:
            f"<logs>/chapters/{chapter}.log",
        conda:
            ENVIRONMENT
        params:
            **chapter_parameters(chapter),
        message:
            f"Figures and tables of the chapter {chapter}"
        script:
            "../scripts/chapter.py"
