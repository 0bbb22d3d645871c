rule figures:
    input:
        expand(
            "<results>/figures/{figure}.{kind}",
            figure=config["figures"],
            kind=["pdf", "png", "rst"],
        ),


rule caption:
    input:
        template=caption,
        code=code("caption.py"),
    output:
        "<results>/figures/{figure}.rst",
    log:
        "<logs>/captions/{figure}.log",
    benchmark:
        "<benchmarks>/captions/{figure}.tsv"
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Caption of {wildcards.figure}"
    script:
        "../scripts/caption.py"


rule draw_schematic:
    input:
        code=code("draw_schematic.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/schematic.rst",
            category="Models and schemes",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("schematic")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_schematic.py"


rule draw_free:
    input:
        unpack(figure_data),
        code=code("draw_free.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/free.rst",
            category="Free oscillator",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("free")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_free.py"


rule draw_design:
    input:
        unpack(figure_data),
        code=code("draw_design.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/design.rst",
            category="Harmonic balance",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("design")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_design.py"


rule draw_motion:
    input:
        unpack(figure_data),
        code=code("draw_motion.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/motion.rst",
            category="Frequency responses",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("motion")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_motion.py"


rule draw_response:
    input:
        unpack(figure_data),
        code=code("draw_response.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/response.rst",
            category="Frequency responses",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("response")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_response.py"


rule draw_optimum:
    input:
        unpack(figure_data),
        code=code("draw_optimum.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/optimum.rst",
            category="Optimum clearance",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("optimum")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_optimum.py"


rule draw_migration:
    input:
        unpack(figure_data),
        code=code("draw_migration.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/migration.rst",
            category="Migration control",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("migration")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_migration.py"


rule draw_release:
    input:
        unpack(figure_data),
        code=code("draw_release.py"),
    output:
        pdf="<results>/figures/{figure}.pdf",
        png=report(
            "<results>/figures/{figure}.png",
            caption="../report/release.rst",
            category="Migration control",
            labels={"figure": "{figure}"},
        ),
    log:
        "<logs>/figures/{figure}.log",
    benchmark:
        "<benchmarks>/figures/{figure}.tsv"
    wildcard_constraints:
        figure=one_of(figures("release")),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=figure_job,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_release.py"
