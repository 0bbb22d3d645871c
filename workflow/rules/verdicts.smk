rule verdicts:
    input:
        data("verdicts"),


rule method_verdicts:
    input:
        code=code("method_verdicts.py"),
        kernels=ancient("<results>/rival_kernels.compiled"),
    output:
        "<results>/verdicts/{judged}.nc",
    log:
        "<logs>/verdicts/{judged}.log",
    benchmark:
        "<benchmarks>/verdicts/{judged}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(verdicts_job, "verdicts"),
    message:
        "Verdicts of integrators by tolerance, {wildcards.judged}"
    script:
        "../scripts/method_verdicts.py"
