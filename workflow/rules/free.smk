rule free:
    input:
        data("free"),


rule free_response:
    input:
        code=code("free_response.py"),
        kernels=ancient("<results>/kernels.compiled"),
    output:
        "<results>/free/{oscillator}.nc",
    log:
        "<logs>/free/{oscillator}.log",
    benchmark:
        "<benchmarks>/free/{oscillator}.tsv"
    cache: SHARED
    priority: 1
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(free_job, "free"),
    message:
        "Motions of the free oscillator {wildcards.oscillator} over frequency"
    script:
        "../scripts/free_response.py"
