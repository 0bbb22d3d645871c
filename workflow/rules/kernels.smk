# The marker file holds the digest of the compiled sources. This rule has neither inputs nor
# parameters: if an edit of an input started this rule, Snakemake would not check whether the jobs
# that depend on the marker have changed themselves (issue 4166 of Snakemake). After an edit of
# kernels the function `compile_again` compiles them, at the start of a run.
rule compile_kernels:
    output:
        "<results>/kernels.compiled",
    log:
        "<logs>/compile_kernels.log",
    # Priorities of all rules. 3: this job, for which most jobs wait. 2: jobs for which other jobs
    # wait. 1: the longest jobs; begun last, they would leave the other core idle at the end of a
    # run.
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
