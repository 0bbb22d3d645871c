# The marker file states which kernels were compiled. This rule has neither inputs nor parameters:
# if an edit of them started it, Snakemake would not examine the jobs that take the marker for
# changes of their own (its issue 4166). So `compile_again` follows edits.
rule compile_kernels:
    output:
        "<results>/kernels.compiled",
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
    message:
        "Compiling the kernels, once for all jobs"
    script:
        "../scripts/compile_kernels.py"
