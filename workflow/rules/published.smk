rule published:
    input:
        code=code("published"),
        kernels=KERNELS,
    output:
        "<results>/published/{name}.nc",
    log:
        "<logs>/published/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("published"),
    message:
        "Published numbers beside ours, {wildcards.name}"
    script:
        "../scripts/published.py"
