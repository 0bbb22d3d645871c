# The marker file says only that kernels were compiled on this machine. It has no inputs, and the
# jobs that need it declare it `ancient`, so compiling again never reruns them. Compiled kernels are
# stored under a digest of their sources, so an outdated one is never run.
rule compile_kernels:
    output:
        touch("<results>/kernels.compiled"),
    log:
        "<logs>/compile_kernels.log",
    # Most jobs wait for it. Next (2) are the jobs that others wait for, then (1) the longest ones,
    # so that no long job is left for the end, when a core would idle beside it.
    priority: 3
    conda:
        ENVIRONMENT
    threads: 2
    resources:
        mem_mb=2000,
    params:
        orders=config["comparison"]["orders"],
    message:
        "Compiling the kernels, once for all jobs"
    script:
        "../scripts/compile_kernels.py"
