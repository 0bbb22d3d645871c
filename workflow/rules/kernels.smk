# The marker file holds the digest of the compiled sources. This rule has neither inputs nor
# parameters: if an edit of an input started this rule, Snakemake would not check the jobs that depend
# on the marker for their own changes (its issue 4166). `compile_again` compiles after edits.
rule compile_kernels:
    output:
        "<results>/kernels.compiled",
    log:
        "<logs>/compile_kernels.log",
    # Priority 3: most jobs wait for this one. Priority 2: other jobs wait for these. Priority 1: the
    # longest jobs, which at the end of a run would leave the other core idle.
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
