rule tables:
    input:
        expand(
            "<results>/tables/{table}.{kind}",
            table=TABLES,
            kind=["csv", "md"],
        ),


rule table:
    input:
        unpack(table_data),
        code=table_code,
    output:
        csv=report(
            "<results>/tables/{table}.csv",
            caption="../report/table.rst",
            category="Tables",
            labels={"table": "{table}"},
        ),
        markdown="<results>/tables/{table}.md",
    log:
        "<logs>/tables/{table}.log",
    benchmark:
        "<benchmarks>/tables/{table}.tsv"
    wildcard_constraints:
        table="|".join(sorted(set(TABLES) - {"claims"})),
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    params:
        module=table_module,
    message:
        "Table of {wildcards.table}"
    script:
        "../scripts/table.py"


rule claims:
    input:
        unpack(table_data),
        code=code("claims.py"),
    output:
        csv=report(
            "<results>/tables/{table}.csv",
            caption="../report/claims.rst",
            category="Tables",
            labels={"table": "{table}"},
        ),
        markdown="<results>/tables/{table}.md",
    log:
        "<logs>/tables/{table}.log",
    benchmark:
        "<benchmarks>/tables/{table}.tsv"
    wildcard_constraints:
        table="claims",
    conda:
        "../envs/impact-damper.yaml"
    threads: 1
    message:
        "Table of {wildcards.table}"
    script:
        "../scripts/claims.py"
