rule machines:
    input:
        code=code("machines"),
        kernels=KERNELS,
    output:
        "<results>/machines/{name}.nc",
    log:
        "<logs>/machines/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("machines"),
    message:
        "The machine {wildcards.name} with its damper, in SI units"
    script:
        "../scripts/machines.py"
