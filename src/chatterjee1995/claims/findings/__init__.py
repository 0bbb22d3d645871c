"""Findings on the claims: sentences that say with numbers what the data show.

A function of this subpackage takes the measures of one claim, numbers with the names in its
`Claim.measures`, as keyword arguments. It returns sentences that are true for every verdict. A
measure that is not needed falls into `others`.
"""
