! The free oscillator Z1'' + h Z1' + Z1**3 = cos(W T) for AUTO, U = (Z1, Z1', sin W T, cos W T).
! AUTO continues periodic orbits of autonomous systems: the last two equations are an oscillator
! of its own that settles on the unit circle and forces the first two.
subroutine func(ndim, u, icp, par, ijac, f, dfdu, dfdp)
  implicit none
  integer, intent(in) :: ndim, ijac, icp(*)
  double precision, intent(in) :: u(ndim), par(*)
  double precision, intent(out) :: f(ndim)
  double precision, intent(inout) :: dfdu(ndim, ndim), dfdp(ndim, *)
  double precision :: frequency, damping, growth

  frequency = par(1)
  damping = par(2)
  growth = 1 - u(3)**2 - u(4)**2
  f(1) = u(2)
  f(2) = u(4) - damping*u(2) - u(1)**3
  f(3) = frequency*u(4) + growth*u(3)
  f(4) = -frequency*u(3) + growth*u(4)
end subroutine func

! The first orbit comes from a file and its parameters from the constants; the rest is not used.
subroutine stpnt
end subroutine stpnt

subroutine bcnd
end subroutine bcnd

subroutine icnd
end subroutine icnd

subroutine fopt
end subroutine fopt

subroutine pvls
end subroutine pvls
