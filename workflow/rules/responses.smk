rule response:
    input:
        code=code("response"),
        kernels=KERNELS,
    output:
        "<results>/response/{name}.nc",
    log:
        "<logs>/response/{name}.log",
    cache: SHARED
    priority: 2
    conda:
        ENVIRONMENT
    params:
        **parameters("response"),
    message:
        "Motions over frequency, of the curve {wildcards.name}"
    script:
        "../scripts/response.py"


rule subharmonic:
    input:
        code=code("subharmonic"),
        kernels=KERNELS,
    output:
        "<results>/subharmonic/{name}.nc",
    log:
        "<logs>/subharmonic/{name}.log",
    cache: SHARED
    priority: 2
    conda:
        ENVIRONMENT
    params:
        **parameters("subharmonic"),
    message:
        "Runs from the one-third subharmonic, for the curve {wildcards.name}"
    script:
        "../scripts/subharmonic.py"


rule branches:
    input:
        motions=read_by("branches"),
        code=code("branches"),
        kernels=KERNELS,
    output:
        "<results>/branches/{name}.nc",
    log:
        "<logs>/branches/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("branches"),
    message:
        "Branches of periodic orbits of the curve {wildcards.name}"
    script:
        "../scripts/branches.py"


rule motion:
    input:
        code=code("motion"),
        kernels=KERNELS,
    output:
        "<results>/motion/{name}.nc",
    log:
        "<logs>/motion/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("motion"),
    message:
        "Steady motion {wildcards.name}"
    script:
        "../scripts/motion.py"


rule collisions:
    input:
        code=code("collisions"),
        kernels=KERNELS,
    output:
        data("collisions"),
    log:
        "<logs>/collisions.log",
    conda:
        ENVIRONMENT
    params:
        **parameters_of_all("collisions"),
    message:
        "Starts that lead to collisions"
    script:
        "../scripts/collisions.py"
