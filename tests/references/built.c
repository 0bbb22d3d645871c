/* Motions of a machine and its loose mass by the fourth-order Runge-Kutta method, in SI units.

   The places x of the machine and u of the loose mass are measured in the frame of the base, which
   adds forces of inertia. The wall pushes with the force stiffness depth + dashpot rate while depth
   and force are positive. The loose mass slides on its floor with the force `friction`, or sticks
   while a smaller force is enough. Bisection locates changes of the wall and of the friction. */

#include <math.h>

typedef struct {
    double mass, damping, linear, cubic, force, base, loose, half, stiffness, dashpot, gravity,
        friction, angular;
} Built;

/* touch: the wall that pushes, -1, 0 or 1. slide: the sign of x' - u', or 0 if the loose mass sticks. */
typedef struct {
    int touch, slide;
} Phase;

static double push(const Built *b, const double *y, int wall)
{
    return b->stiffness * (wall * (y[0] - y[2]) - b->half) + b->dashpot * wall * (y[1] - y[3]);
}

static int touched(const Built *b, const double *y)
{
    double apart = y[0] - y[2];
    int wall = apart > 0 ? 1 : -1;
    return wall * apart > b->half && push(b, y, wall) > 0 ? wall : 0;
}

/* Forces on machine and loose mass without friction. */
static void forces(const Built *b, double t, const double *y, int wall, double *on)
{
    double wave = cos(b->angular * t), wall_force = wall ? wall * push(b, y, wall) : 0;
    on[0] = (b->force + b->mass * b->base) * wave - b->damping * y[1] - b->linear * y[0]
            - b->cubic * y[0] * y[0] * y[0] - wall_force;
    on[1] = b->loose * (b->base * wave - b->gravity) + wall_force;
}

/* Friction on the machine that keeps the loose mass at rest on the machine. */
static double holding(const Built *b, double t, const double *y, int wall)
{
    double on[2];
    forces(b, t, y, wall, on);
    return (b->mass * on[1] - b->loose * on[0]) / (b->mass + b->loose);
}

static void rates(const Built *b, double t, const double *y, Phase phase, double *rate)
{
    double on[2];
    forces(b, t, y, phase.touch, on);
    double rub = -b->friction * phase.slide;
    if (b->friction > 0 && !phase.slide) rub = holding(b, t, y, phase.touch);
    rate[0] = y[1], rate[2] = y[3];
    rate[1] = (on[0] + rub) / b->mass, rate[3] = (on[1] - rub) / b->loose;
}

static void step(const Built *b, double t, const double *y, Phase phase, double h, double *out)
{
    double k[4][4], at[4];
    const double part[3] = {h / 2, h / 2, h};
    rates(b, t, y, phase, k[0]);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++) at[j] = y[j] + part[i] * k[i][j];
        rates(b, t + part[i], at, phase, k[i + 1]);
    }
    for (int j = 0; j < 4; j++)
        out[j] = y[j] + h / 6 * (k[0][j] + 2 * k[1][j] + 2 * k[2][j] + k[3][j]);
}

/* Whether the phase no longer holds at a state. */
static int changed(const Built *b, double t, const double *y, Phase phase)
{
    if (touched(b, y) != phase.touch) return 1;
    if (!(b->friction > 0)) return 0;
    if (phase.slide) return phase.slide * (y[1] - y[3]) <= 0;
    return fabs(holding(b, t, y, phase.touch)) > b->friction;
}

/* The phase from a state on. If the sliding speed changes sign, the loose mass is set at rest. */
static Phase phase_at(const Built *b, double t, double *y, Phase before)
{
    Phase phase = {touched(b, y), before.slide};
    if (!(b->friction > 0)) return phase;
    int turned = before.slide && before.slide * (y[1] - y[3]) <= 0;
    if (before.slide && !turned) return phase;
    double need = holding(b, t, y, phase.touch);
    if (turned) y[3] = y[1];
    phase.slide = fabs(need) <= b->friction ? 0 : need < 0 ? 1 : -1;
    if (phase.slide) y[3] = y[1] - 1e-12 * phase.slide;
    return phase;
}

/* Largest |x| of one motion (x, x', z, z' with z = x - u) between the times `lead` and `end`; `flight`
   and `contact` are the longest steps. */
double largest(const double *given, const double *state, double begin, double lead, double end,
               double flight, double contact)
{
    const Built *b = (const Built *)given;
    double y[4] = {state[0], state[1], state[0] - state[2], state[1] - state[3]};
    double t = begin, most = 0, next[4];
    Phase phase = {touched(b, y), state[3] > 0 ? 1 : -1};
    while (t < end) {
        int near = fabs(y[0] - y[2]) > b->half;
        double h = phase.touch || near ? contact : flight;
        step(b, t, y, phase, h, next);
        if (changed(b, t + h, next, phase)) {
            double low = 0, high = h;
            for (int i = 0; i < 40; i++) {
                double middle = (low + high) / 2;
                step(b, t, y, phase, middle, next);
                if (changed(b, t + middle, next, phase)) high = middle;
                else low = middle;
            }
            h = high;
            step(b, t, y, phase, h, next);
            phase = phase_at(b, t + h, next, phase);
        }
        for (int j = 0; j < 4; j++) y[j] = next[j];
        t += h;
        if (t > lead && fabs(y[0]) > most) most = fabs(y[0]);
    }
    return most;
}
