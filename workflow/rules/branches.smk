def span_of(oscillator):
    """Ends of an oscillator's range of frequencies."""
    span = config["oscillators"][oscillator]["frequencies"]
    return [span["first"], span["last"]]


def free_branches_job(wildcards):
    return {
        "oscillator": oscillator_of(wildcards.oscillator),
        "frequencies": span_of(wildcards.oscillator),
    }


def branches_job(wildcards):
    curve = config["curves"][wildcards.curve]
    return {
        "oscillator": oscillator_of(curve["oscillator"]),
        "damper": damper_of(curve),
        "frequencies": span_of(curve["oscillator"]),
    }


def branch_motions(wildcards):
    """Files of the motions from which the branches of a curve begin."""
    stages = config["curves"][wildcards.curve]["stages"]
    return [
        path
        for stage in ("response", "subharmonic")
        if stage in stages
        for path in data(stage, [wildcards.curve])
    ]


rule branches:
    input:
        data("free_branches"),
        data("branches"),


rule free_branches:
    input:
        motions=["<results>/free/{oscillator}.nc"],
        code=code("free_branches.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/free_branches/{oscillator}.nc",
    log:
        "<logs>/free_branches/{oscillator}.log",
    benchmark:
        "<benchmarks>/free_branches/{oscillator}.tsv"
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=free_branches_job,
    message:
        "Branches of orbits of the free oscillator {wildcards.oscillator}"
    script:
        "../scripts/free_branches.py"


rule damped_branches:
    input:
        motions=branch_motions,
        code=code("damped_branches.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/branches/{curve}.nc",
    log:
        "<logs>/branches/{curve}.log",
    benchmark:
        "<benchmarks>/branches/{curve}.tsv"
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        job=branches_job,
    message:
        "Branches of orbits with the damper, for the curve {wildcards.curve}"
    script:
        "../scripts/damped_branches.py"
