rule balance_map:
    input:
        data("balance_map"),


rule harmonic_balance_map:
    input:
        code=code("harmonic_balance_map.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/balance_map/{balance_map}.nc",
    log:
        "<logs>/balance_map/{balance_map}.log",
    benchmark:
        "<benchmarks>/balance_map/{balance_map}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(balance_map_job, "balance_map"),
    message:
        "Harmonic balance against the true motions, the map {wildcards.balance_map}"
    script:
        "../scripts/harmonic_balance_map.py"
