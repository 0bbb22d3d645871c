"""Published numbers, and the same quantities computed by this package."""

from impact_damper.data.variables import register

register(
    """
comparison | comparison | | | quantity that is compared, with its parameters
publication | comparison | | | publication of the number or of its closed form
  : masri_caughey 0, slow_manifold 1, den_hartog 2, nishihara_asami 3, habib 4, bstab 5,
  : brennan 6, hertz 7
published_value | comparison | | | published number, or value of the published closed form
our_value | comparison | | | number computed here
difference_reason | comparison | | | why the numbers differ: finite contact stiffness, closed form
  of first order in the mass ratio, height of fixed points in place of peaks, tolerance of a
  direct search, closed form of first order in the force, random starts, closed form with one
  harmonic, linear contact
  : contact_stiffness 0, mass_ratio 1, fixed_points 2, direct_search 3, first_order 4,
  : random_starts 5, one_harmonic 6, linear_contact 7
difference_order | comparison | | | exponent n of difference ~ parameter^n; difference_reason
  names the parameter
difference_error | comparison | | | standard error of the difference of two random counts
limit_value | comparison | | | number computed here, extrapolated to rigid walls
expected_difference | comparison | | | expected size of the relative difference: from the
  extrapolation to rigid walls, the mass ratio, 1.96 standard errors, or a linear contact; NaN if
  unknown
    """,
)
