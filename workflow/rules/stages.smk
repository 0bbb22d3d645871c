# For each stage a rule. Jobs of the rule call the stage's function, which the registry names.
for stage in STAGES.values():

    if stage.name != "studies":

        rule:
            name:
                stage.name
            input:
                **inputs(stage),
                code=code("stage", stage.function.split(":")[0]),
            output:
                data(stage.name) if stage.together else f"<results>/{stage.name}/{{name}}.nc",
            log:
                f"<logs>/{stage.name}.log"
                if stage.together
                else f"<logs>/{stage.name}/{{name}}.log",
            cache: SHARED and not stage.together
            priority: stage.priority
            conda:
                ENVIRONMENT
            params:
                **parameters(stage),
            message:
                stage.message.format(name="{wildcards.name}")
            script:
                "../scripts/stage.py"


# A study is computed in chunks, each by its own job.
rule study_chunks:
    input:
        code=code("stage", STAGES["studies"].function.split(":")[0]),
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
        **parameters_of_chunks(),
    message:
        "Chunk {wildcards.chunk} of the study {wildcards.name}"
    script:
        "../scripts/stage.py"


rule studies:
    input:
        chunks=chunks_of_study,
        code=code("studies", STAGES["studies"].function.split(":")[0]),
    output:
        "<results>/studies/{name}.nc",
    log:
        "<logs>/studies/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        name=named,
    message:
        "The study {wildcards.name}"
    script:
        "../scripts/studies.py"
