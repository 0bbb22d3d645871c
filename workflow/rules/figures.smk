# Kinds of figures of data: the category of each in the report. A kind has a module, a caption,
# and a place in SECTIONS of `contradictions.py`.
KINDS = {
    "free": "Free oscillator",
    "design": "Harmonic balance",
    "motion": "Frequency responses",
    "response": "Frequency responses",
    "branches": "Exact orbits",
    "optimum": "Optimum clearance",
    "migration": "Migration control",
    "release": "Migration control",
    "contact_model": "Where methods fail",
    "rigid_limit": "Where methods fail",
    "design_rules": "Optimum clearance",
    "harmonics": "Harmonic balance",
    "missed_contacts": "Where methods fail",
    "stable_steps": "Where methods fail",
    "verdicts": "Where methods fail",
    "balance_map": "Where methods fail",
    "accuracy": "Speed against accuracy",
    "studies": "Optimum clearance",
}


rule figures:
    input:
        expand(
            "<results>/figures/{figure}.{kind}",
            figure=config["figures"],
            kind=["pdf", "png", "rst"],
        ),


# One job for all of them: to start a job for each would cost more than what it does.
rule captions:
    input:
        templates=[caption_template(name) for name in config["figures"]],
        code=code("captions.py"),
    output:
        expand("<results>/figures/{figure}.rst", figure=config["figures"]),
    log:
        "<logs>/captions.log",
    benchmark:
        "<benchmarks>/captions.tsv"
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        *[partial(caption_of, name) for name in config["figures"]],
    message:
        "Captions of the figures"
    script:
        "../scripts/captions.py"


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
        data=figure_entries,
        job=figure_caption,
    message:
        "Drawing {wildcards.figure}"
    script:
        "../scripts/draw_schematic.py"


for kind, category in KINDS.items():

    rule:
        name:
            f"draw_{kind}"
        input:
            unpack(figure_data),
            code=figure_code,
        output:
            pdf="<results>/figures/{figure}.pdf",
            png=report(
                "<results>/figures/{figure}.png",
                caption=f"../report/{kind}.rst",
                category=category,
                labels={"figure": "{figure}"},
            ),
        log:
            "<logs>/figures/{figure}.log",
        benchmark:
            "<benchmarks>/figures/{figure}.tsv"
        wildcard_constraints:
            figure=one_of(figures(kind)),
        conda:
            "../envs/impact-damper.yaml"
        threads: 1
        params:
            kind=figure_kind,
            data=figure_entries,
            job=figure_caption,
            module=figure_module,
        message:
            "Drawing {wildcards.figure}"
        script:
            "../scripts/draw.py"
