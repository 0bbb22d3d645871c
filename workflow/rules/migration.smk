rule migration:
    input:
        code=code("migration"),
        kernels=KERNELS,
    output:
        "<results>/migration/{name}.nc",
    log:
        "<logs>/migration/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("migration"),
    message:
        "Migration control, the case {wildcards.name}"
    script:
        "../scripts/migration.py"


rule release_scan:
    input:
        code=code("release_scan"),
        kernels=KERNELS,
    output:
        "<results>/release_scan/{name}.nc",
    log:
        "<logs>/release_scan/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("release_scan"),
    message:
        "Motions after the damper is switched off, over frequency, the scan {wildcards.name}"
    script:
        "../scripts/release_scan.py"


rule basins:
    input:
        code=code("basins"),
        kernels=KERNELS,
    output:
        "<results>/basins/{name}.nc",
    log:
        "<logs>/basins/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("basins"),
    message:
        "Motions to which the states of a plane lead, the plane {wildcards.name}"
    script:
        "../scripts/basins.py"


rule release_policies:
    input:
        code=code("release_policies"),
        kernels=KERNELS,
    output:
        "<results>/release_policies/{name}.nc",
    log:
        "<logs>/release_policies/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("release_policies"),
    message:
        "Policies of migration, the dampers {wildcards.name}"
    script:
        "../scripts/release_policies.py"
