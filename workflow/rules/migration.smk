rule migration:
    input:
        data("migration"),


rule migration_trials:
    input:
        code=code("migration_trials.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/migration/{run}.nc",
    log:
        "<logs>/migration/{run}.log",
    benchmark:
        "<benchmarks>/migration/{run}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(migration_job, "migration"),
    message:
        "Migration control, the case {wildcards.run}"
    script:
        "../scripts/migration_trials.py"
