# The marker says that kernels were compiled here, and no more: it has no inputs and is ancient to
# those who wait for it. Kernels are kept by the digest of their sources, so a stale one is never
# run, and an edit of the sources reaches the jobs through their own inputs.
rule kernels:
    output:
        touch("<results>/kernels.compiled"),
    log:
        "<logs>/kernels.log",
    benchmark:
        "<benchmarks>/kernels.tsv"
    # Most jobs wait for it, so it goes first. Next (1) are the longest jobs and those that branches
    # wait for, so that no long job is left for the end, when a core would idle beside it.
    priority: 2
    conda:
        "../envs/impact-damper.yaml"
    threads: 2
    resources:
        mem_mb=2000,
    message:
        "Compiling the kernels, once for all jobs"
    script:
        "../scripts/kernels.py"


rule rival_kernels:
    input:
        kernels=ancient("<results>/kernels.compiled"),
    output:
        touch("<results>/rival_kernels.compiled"),
    log:
        "<logs>/rival_kernels.log",
    benchmark:
        "<benchmarks>/rival_kernels.tsv"
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        orders=config["comparison"]["orders"],
    message:
        "Compiling the methods to compare with, once for all jobs"
    script:
        "../scripts/rival_kernels.py"
