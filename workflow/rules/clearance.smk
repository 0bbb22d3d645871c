rule optimum:
    input:
        code=code("optimum"),
        kernels=KERNELS,
    output:
        "<results>/optimum/{name}.nc",
    log:
        "<logs>/optimum/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("optimum"),
    message:
        "Largest displacement against clearance, and its optimum, for {wildcards.name}"
    script:
        "../scripts/optimum.py"


rule design_rules:
    input:
        code=code("design_rules"),
        kernels=KERNELS,
    output:
        "<results>/design_rules/{name}.nc",
    log:
        "<logs>/design_rules/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("design_rules"),
    message:
        "Rules for the clearance against the optimum of the motion, on the grid {wildcards.name}"
    script:
        "../scripts/design_rules.py"


# With `chunks: 1` the job of a study computes all cells. Otherwise it joins the files of the chunks.
rule study_chunks:
    input:
        code=code("study_chunks"),
        kernels=KERNELS,
    output:
        "<results>/study_chunks/{name}/{chunk}.nc",
    log:
        "<logs>/study_chunks/{name}/{chunk}.log",
    wildcard_constraints:
        chunk="[0-9]+-of-[0-9]+",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("studies", study_chunk),
    message:
        "Chunk {wildcards.chunk} of the study {wildcards.name}"
    script:
        "../scripts/study_chunks.py"


rule studies:
    input:
        chunks=chunks_of_study,
        code=code("studies"),
        kernels=KERNELS,
    output:
        "<results>/studies/{name}.nc",
    log:
        "<logs>/studies/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("studies"),
    message:
        "The study {wildcards.name}"
    script:
        "../scripts/studies.py"
