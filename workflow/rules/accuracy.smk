rule accuracy:
    input:
        data("accuracy"),


rule scene_accuracy:
    input:
        references=local(ROOT / "workflow/resources/references.json"),
        code=code("scene_accuracy.py"),
        kernels=ancient("<results>/rival_kernels.compiled"),
    output:
        "<results>/accuracy/{scene}.nc",
    log:
        "<logs>/accuracy/{scene}.log",
    benchmark:
        "<benchmarks>/accuracy/{scene}.tsv"
    cache: SHARED
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        **parts(accuracy_job, "accuracy"),
    message:
        "Errors of methods against counted work, {wildcards.scene}"
    script:
        "../scripts/scene_accuracy.py"
