rule balance_map:
    input:
        code=code("balance_map"),
        kernels=KERNELS,
    output:
        "<results>/balance_map/{name}.nc",
    log:
        "<logs>/balance_map/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("balance_map"),
    message:
        "Harmonic balance against exact motions, the map {wildcards.name}"
    script:
        "../scripts/balance_map.py"


rule contact_model:
    input:
        code=code("contact_model"),
        kernels=KERNELS,
    output:
        "<results>/contact_model/{name}.nc",
    log:
        "<logs>/contact_model/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("contact_model"),
    message:
        "Contact model and contacts of motions, {wildcards.name}"
    script:
        "../scripts/contact_model.py"


rule rigid_limit:
    input:
        code=code("rigid_limit"),
        kernels=KERNELS,
    output:
        data("rigid_limit"),
    log:
        "<logs>/rigid_limit.log",
    conda:
        ENVIRONMENT
    params:
        **parameters_of_all("rigid_limit"),
    message:
        "Rigid impacts against compliant contact"
    script:
        "../scripts/rigid_limit.py"


rule missed_contacts:
    input:
        code=code("missed_contacts"),
        kernels=KERNELS,
    output:
        "<results>/missed_contacts/{name}.nc",
    log:
        "<logs>/missed_contacts/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("missed_contacts"),
    message:
        "Contacts near grazing that integrators miss, {wildcards.name}"
    script:
        "../scripts/missed_contacts.py"


rule stable_steps:
    input:
        code=code("stable_steps"),
        kernels=KERNELS,
    output:
        "<results>/stable_steps/{name}.nc",
    log:
        "<logs>/stable_steps/{name}.log",
    cache: SHARED
    conda:
        ENVIRONMENT
    params:
        **parameters("stable_steps"),
    message:
        "Largest stable steps of fixed-step methods, {wildcards.name}"
    script:
        "../scripts/stable_steps.py"


rule accuracy:
    input:
        references=local(ROOT / "workflow/resources/references.json"),
        code=code("accuracy"),
        kernels=KERNELS,
    output:
        "<results>/accuracy/{name}.nc",
    log:
        "<logs>/accuracy/{name}.log",
    cache: SHARED
    priority: 1
    conda:
        ENVIRONMENT
    params:
        **parameters("accuracy"),
    message:
        "Errors of methods against counted work, {wildcards.name}"
    script:
        "../scripts/accuracy.py"
