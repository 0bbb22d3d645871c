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
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(free_branches_job, "free_branches"),
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
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(branches_job, "branches"),
    message:
        "Branches of orbits with the damper, for the curve {wildcards.curve}"
    script:
        "../scripts/damped_branches.py"
