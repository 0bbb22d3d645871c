/* Motions of the damped oscillator in the processor's extended precision (80 bits).

   Equations (3), (4) and (20) to (24) of the paper are integrated by a Taylor series of fixed
   order. The program shares no code with the kernels, the package's integrators. An event is the
   beginning or the end of a contact, a root of the distance to a wall, which is a polynomial over a
   step. The signs of its Bernstein coefficients prove that there is no event, or isolate it: in an
   interval a polynomial has at most as many roots as its Bernstein coefficients have changes of
   sign (Descartes' rule; Farouki, Computer Aided Geometric Design 29, 2012). No change means no
   root, one change means one root; with more changes the interval is halved.

   Z2 is kept as its distance from the wall that was touched last. A state on that wall is then
   exactly zero, so that this root can be divided out and cannot hide the next root.

   A contact ends when depth + lag (rate of the depth) falls to zero. If the depth is still positive
   then, the wall pushes again if this sum rises before the depth is zero. Friction must be 0. */

#include <math.h>
#include <string.h>

typedef long double real;

enum { ORDER = 32, TERMS = ORDER + 1, MOST_ROOTS = ORDER };
enum { DONE, LOG_FULL, TOO_MANY_STEPS };

/* The members have the names and the order of the packed parameters. */
typedef struct {
    real frequency, damping, stiffness, cubic, force, unbalance, base, clearance,
        contact_stiffness, inverse_mass_ratio, dashpot, lag, gravity, friction;
} Parameters;

/* One step: Taylor coefficients of Z1, of the distance z of Z2 from the wall, of Z1^2, and of
   the derivatives of Z1 and z by the four initial values. */
typedef struct {
    real x[TERMS], z[TERMS], square[TERMS], dx[4][TERMS], dz[4][TERMS];
} Series;

typedef struct {
    real m[4][4];
} Matrix;

/* A run under way. `origin` is the wall from which z is measured (Z2 = origin + z), `side` the wall
   in contact or 0. Instants are the start, the events and the requested times. `since` is the
   derivative of the present state with respect to the state at the last instant; flows[i] is the
   derivative of the state at the last instant with respect to the state at instant i. */
typedef struct {
    const Parameters *p;
    real y[4], origin, t;
    int side;
    Matrix since, *flows;
    long instants;
    real *turnings;
    long turning_count, room;
    int status;
} Run;

static const Matrix IDENTITY = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

static real value(const real *c, real t)
{
    real sum = c[ORDER];
    for (int k = ORDER - 1; k >= 0; k--) sum = sum * t + c[k];
    return sum;
}

static void differentiate(const real *c, real *slope)
{
    for (int k = 0; k < ORDER; k++) slope[k] = (k + 1) * c[k + 1];
    slope[ORDER] = 0;
}

/* ---- roots of a step's polynomials ---- */

static void bernstein(const real *c, real length, real *b)
{
    real power = 1, binomial = 1;
    for (int k = 0; k <= ORDER; k++) {
        b[k] = c[k] * power / binomial;
        power *= length;
        binomial = binomial * (ORDER - k) / (k + 1);
    }
    for (int k = 1; k <= ORDER; k++)
        for (int i = ORDER; i >= k; i--) b[i] += b[i - 1];
}

static int sign_changes(const real *b)
{
    int changes = 0;
    real last = 0;
    for (int k = 0; k <= ORDER; k++) {
        if (b[k] == 0) continue;
        if (last != 0 && (last < 0) != (b[k] < 0)) changes++;
        last = b[k];
    }
    return changes;
}

/* The only root between left and right, by Newton's method. Steps beyond these are bisections. */
static real refine(const real *c, real left, real right, int rising)
{
    real slope[TERMS], t = (left + right) / 2;
    differentiate(c, slope);
    for (int i = 0; i < 200; i++) {
        real f = value(c, t);
        if (f == 0) break;
        if ((f > 0) == rising) right = t;
        else left = t;
        real next = t - f / value(slope, t);
        if (!(next > left && next < right)) next = (left + right) / 2;
        if (next == t || fabsl(next - t) <= 0x1p-66L * t) break;
        t = next;
    }
    return t;
}

/* Roots inside (left, right) in increasing order, at most `most`; b holds the Bernstein
   coefficients of this interval. Roots that rounding cannot separate are skipped. If the sign
   differs after these roots, `roots` reports a root at the beginning of the next step. */
static int isolate(const real *c, const real *b, real left, real right, real *found, int most)
{
    int changes = sign_changes(b);
    if (changes == 0 || most == 0) return 0;
    if (changes == 1) {
        int first = 0;
        while (b[first] == 0) first++;
        found[0] = refine(c, left, right, b[first] < 0);
        return 1;
    }
    real middle = (left + right) / 2;
    if (right - left <= 0x1p-62L * right) return 0;
    real near[TERMS], far[TERMS];
    memcpy(far, b, sizeof far);
    for (int k = 0; k <= ORDER; k++) { /* de Casteljau's halving */
        near[k] = far[0];
        for (int i = 0; i < ORDER - k; i++) far[i] = (far[i] + far[i + 1]) / 2;
    }
    /* far[] now holds the right half. */
    int count = isolate(c, near, left, middle, found, most);
    if (far[0] == 0 && count < most) found[count++] = middle;
    return count + isolate(c, far, middle, right, found + count, most - count);
}

/* Whether the first coefficient outweighs all others, so that there is certainly no root. */
static int far_from_zero(const real *c, real length)
{
    real rest = 0;
    for (int k = ORDER; k > 0; k--) rest = (rest + fabsl(c[k])) * length;
    return fabsl(c[0]) > rest;
}

/* Roots in (0, length); roots at zero are divided out. If `sign` is not 0 and the polynomial just
   after zero has the opposite sign, zero itself counts as the first root. */
static int roots(const real *series, real length, int sign, real *found, int most)
{
    real c[TERMS], b[TERMS];
    int zeros = 0;
    while (zeros < ORDER && series[zeros] == 0) zeros++;
    memset(c, 0, sizeof c);
    memcpy(c, series + zeros, (TERMS - zeros) * sizeof(real));
    if (sign && c[0] * sign < 0) {
        found[0] = 0;
        return 1;
    }
    if (far_from_zero(c, length)) return 0;
    bernstein(c, length, b);
    return isolate(c, b, 0, length, found, most);
}

/* ---- the step ---- */

static void expand(const Run *run, Series *s)
{
    const Parameters *p = run->p;
    real w = p->frequency, phase = w * run->t;
    real factor = p->force + p->unbalance * w * w;
    real drive[4] = {cosl(phase), -sinl(phase), -cosl(phase), sinl(phase)};
    int touching = run->side != 0, columns = touching ? 4 : 2;
    memset(s, 0, sizeof *s);
    s->x[0] = run->y[0], s->x[1] = run->y[1], s->z[0] = run->y[2], s->z[1] = run->y[3];
    s->dx[0][0] = s->dx[1][1] = s->dz[2][0] = s->dz[3][1] = 1;
    for (int k = 0; k + 2 <= ORDER; k++) {
        real cube = 0, square = 0, both = (real)(k + 1) * (k + 2);
        for (int j = 0; j <= k; j++) square += s->x[j] * s->x[k - j];
        s->square[k] = square;
        for (int j = 0; j <= k; j++) cube += s->square[j] * s->x[k - j];
        real force = touching ? p->contact_stiffness * s->z[k] + p->dashpot * (k + 1) * s->z[k + 1] : 0;
        real rest = drive[k % 4] * factor - p->damping * (k + 1) * s->x[k + 1]
                    - p->stiffness * s->x[k] - p->cubic * cube - force;
        s->x[k + 2] = rest / both;
        real across = (k == 0 ? p->gravity : 0) - p->base * drive[k % 4] * factor;
        s->z[k + 2] = (rest + across - p->inverse_mass_ratio * force) / both;
        factor *= w / (k + 1);
        for (int i = 0; i < columns; i++) {
            real *dx = s->dx[i], *dz = s->dz[i];
            cube = 0;
            for (int j = 0; j <= k; j++) cube += s->square[j] * dx[k - j];
            force = touching ? p->contact_stiffness * dz[k] + p->dashpot * (k + 1) * dz[k + 1] : 0;
            rest = -p->damping * (k + 1) * dx[k + 1] - p->stiffness * dx[k]
                   - 3 * p->cubic * cube - force;
            dx[k + 2] = rest / both;
            dz[k + 2] = (rest - p->inverse_mass_ratio * force) / both;
        }
    }
}

/* Longest step for which the last four terms of the slope are at most `allowed`. */
static real reach(const real *c, real allowed)
{
    double shortest = INFINITY;
    for (int k = ORDER - 3; k <= ORDER; k++)
        if (c[k] != 0) shortest = fmin(shortest, pow(allowed / (k * fabsl(c[k])), 1.0 / (k - 1)));
    return shortest;
}

/* Height of Z2 beyond the wall `side` as a polynomial over the step; negative inside the gap. */
static void height(const Run *run, const Series *s, int side, real *c)
{
    for (int k = 0; k <= ORDER; k++) c[k] = side * s->z[k];
    c[0] += side * run->origin - run->p->clearance;
}

/* The height plus `lag` times its rate, which has the sign of the wall's force. */
static void push(const Run *run, const Series *s, int side, real *c)
{
    height(run, s, side, c);
    for (int k = 0; k < ORDER; k++) c[k] += side * run->p->lag * (k + 1) * s->z[k + 1];
}

/* Time of the first event within `length`, or `length` without event; `wall` becomes the wall in
   contact afterwards, or 0. `left` becomes 1 if the event is that Z2 leaves a wall which no longer
   pushes. */
static real first_event(const Run *run, const Series *s, real length, int *wall, int *left)
{
    real c[TERMS], found;
    int outside = run->origin * run->y[2] > 0;
    *wall = run->side;
    *left = 0;
    if (outside && !run->side) {
        int side = run->origin > 0 ? 1 : -1;
        height(run, s, side, c);
        if (roots(c, length, 0, &found, 1)) {
            *left = 1;
            length = found;
        }
        real slope[TERMS], rising[MOST_ROOTS];
        push(run, s, side, c);
        differentiate(c, slope);
        int count = roots(c, length, 0, rising, MOST_ROOTS);
        for (int i = count - 1; i >= 0; i--)
            if (value(slope, rising[i]) > 0) {
                *wall = side, *left = 0;
                length = rising[i];
            }
        return length;
    }
    if (run->side) {
        push(run, s, run->side, c);
        /* Where a contact begins at a depth, a rising push below zero is a rounding error. */
        if (c[0] < 0 && c[1] > 0) c[0] = 0;
        if (roots(c, length, 1, &found, 1)) {
            *wall = 0;
            length = found;
        }
        return length;
    }
    for (int side = -1; side <= 1 && isfinite(run->p->clearance); side += 2) {
        height(run, s, side, c);
        if (roots(c, length, -1, &found, 1)) {
            *wall = side;
            length = found;
        }
    }
    return length;
}

/* ---- the flow's derivative ---- */

static Matrix product(const Matrix *a, const Matrix *b)
{
    Matrix c;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            c.m[i][j] = 0;
            for (int k = 0; k < 4; k++) c.m[i][j] += a->m[i][k] * b->m[k][j];
        }
    return c;
}

/* Sum of the absolute values of a row. The maximum norm of a matrix is its largest such sum. */
static real row_sum(const real *row)
{
    return fabsl(row[0]) + fabsl(row[1]) + fabsl(row[2]) + fabsl(row[3]);
}

static void new_instant(Run *run)
{
    if (run->instants == run->room) {
        run->status = LOG_FULL;
        return;
    }
    for (long i = 0; i < run->instants; i++)
        run->flows[i] = product(&run->since, &run->flows[i]);
    run->since = run->flows[run->instants++] = IDENTITY;
}

static Matrix step_derivative(const Series *s, real length)
{
    Matrix a;
    for (int j = 0; j < 4; j++) {
        real slope[TERMS];
        differentiate(s->dx[j], slope);
        a.m[0][j] = value(s->dx[j], length), a.m[1][j] = value(slope, length);
        differentiate(s->dz[j], slope);
        a.m[2][j] = value(s->dz[j], length), a.m[3][j] = value(slope, length);
    }
    return a;
}

/* Jump of the derivative where the dashpot's force begins (-1) or ends (+1). */
static void saltation(Run *run, int direction)
{
    const Parameters *p = run->p;
    for (int j = 0; j < 4; j++) {
        real jump = direction * p->dashpot * run->since.m[2][j];
        run->since.m[1][j] += jump;
        run->since.m[3][j] += jump * (1 + p->inverse_mass_ratio);
    }
}

/* ---- records of a run ---- */

/* Largest factor by which an error of the state at an instant has grown to an error of Z2; `row` is
   the derivative of Z2 with respect to the state at the last instant. */
static real growth_of_gap(const Run *run, const real *row)
{
    real growth = 1;
    for (long i = 0; i < run->instants; i++) {
        real now[4] = {0, 0, 0, 0};
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 4; k++) now[j] += row[k] * run->flows[i].m[k][j];
        growth = fmaxl(growth, row_sum(now));
    }
    return growth;
}

/* Record an extremum of Z2 = origin + z, or the last Z2, with the height of Z2 beyond the nearer
   wall. If |height| is small, an error decides whether there is a contact. */
static void note_turning(Run *run, real t, real z, const real *row)
{
    int side = run->origin + z < 0 ? -1 : 1;
    real height = side * z + (side * run->origin - run->p->clearance);
    real growth = growth_of_gap(run, row);
    if (run->turning_count == run->room) {
        run->status = LOG_FULL;
        return;
    }
    real entry[4] = {t, side, height, growth};
    memcpy(run->turnings + 4 * run->turning_count++, entry, sizeof entry);
}

static void look_for_turnings(Run *run, const Series *s, real length)
{
    real slope[TERMS], found[MOST_ROOTS];
    differentiate(s->z, slope);
    int count = roots(slope, length, 0, found, MOST_ROOTS);
    for (int i = 0; i < count; i++) {
        Matrix a = step_derivative(s, found[i]);
        a = product(&a, &run->since);
        note_turning(run, run->t + found[i], value(s->z, found[i]), a.m[2]);
    }
}

static void look_for_extremes(const Series *s, real length, real *extremes)
{
    real slope[TERMS], found[MOST_ROOTS + 2];
    differentiate(s->x, slope);
    int count = roots(slope, length, 0, found, MOST_ROOTS);
    found[count++] = 0;
    found[count++] = length;
    for (int i = 0; i < count; i++) {
        real x = value(s->x, found[i]);
        extremes[0] = fminl(extremes[0], x);
        extremes[1] = fmaxl(extremes[1], x);
    }
}

/* ---- runs ---- */

static int start_side(const Run *run, const real *y)
{
    real depth = fabsl(y[2]) - run->p->clearance;
    int wall = y[2] > 0 ? 1 : -1;
    if (depth < 0 || (run->p->lag > 0 && depth + run->p->lag * wall * y[3] <= 0)) return 0;
    return depth > 0 || wall * y[3] > 0 ? wall : 0;
}

/* Append a contact with `wall` that begins now. */
static void begin_contact(Run *run, int wall, real *contacts, long *logged)
{
    if (*logged == run->room) {
        run->status = LOG_FULL;
        return;
    }
    real row[5] = {wall, run->t, NAN, run->y[3], NAN};
    memcpy(contacts + 5 * (*logged)++, row, sizeof row);
}

/* One run from `start` through the n increasing `times`.

   settings: allowed local error (relative to the state if the state exceeds 1), longest step.
   Class Run in __init__.py explains states, extremes, contacts, turnings, flow and growth. flows has
   space for `room` matrices, the logs for `room` rows. counts: contacts begun, rows
   of contacts, rows of turnings. */
int motion(const double *packed, const real *first, real start, const real *times, long n,
           const real *settings, long room, real *states, real *extremes, real *contacts,
           real *turnings, real *flows, real *flow, real *growth, long *counts)
{
    Parameters p;
    for (size_t i = 0; i < sizeof p / sizeof(real); i++) ((real *)&p)[i] = packed[i];
    Run run = {.p = &p, .t = start, .since = IDENTITY,
               .flows = (Matrix *)flows, .turnings = turnings, .room = room};
    Series s;
    long logged = 0, begun = 0, steps = 0;
    new_instant(&run);
    memcpy(run.y, first, sizeof run.y);
    run.side = start_side(&run, first);
    if (isfinite(p.clearance) && fabsl(first[2]) >= p.clearance) {
        run.origin = copysignl(p.clearance, first[2]);
        run.y[2] -= run.origin;
    }
    if (run.side) begin_contact(&run, run.side, contacts, &logged);
    for (long i = 0; i < n && run.status == DONE; i++) {
        extremes[2 * i] = INFINITY, extremes[2 * i + 1] = -INFINITY;
        while (run.t < times[i] && run.status == DONE) {
            int wall, left_wall;
            expand(&run, &s);
            real now = fmaxl(fmaxl(1, fabsl(run.y[0])), fmaxl(fabsl(run.y[1]), fabsl(run.y[3])));
            real allowed = settings[0] * now, left = times[i] - run.t;
            real longest = fminl(settings[1], reach(s.x, allowed));
            if (run.side) longest = fminl(longest, reach(s.z, allowed));
            real length = first_event(&run, &s, fminl(longest, left), &wall, &left_wall);
            if (isfinite(p.clearance)) look_for_turnings(&run, &s, length);
            look_for_extremes(&s, length, extremes + 2 * i);
            Matrix step = step_derivative(&s, length);
            run.since = product(&step, &run.since);
            real slope[TERMS];
            run.y[0] = value(s.x, length), run.y[2] = value(s.z, length);
            differentiate(s.x, slope), run.y[1] = value(slope, length);
            differentiate(s.z, slope), run.y[3] = value(slope, length);
            run.t = length == left ? times[i] : run.t + length;
            if (++steps > 10000000) run.status = TOO_MANY_STEPS;
            if (left_wall) run.y[2] = 0;
            if (wall == run.side) continue;
            /* The force jumps only at the wall's surface. */
            int deep = run.side ? p.lag > 0 : run.origin == wall * p.clearance && run.y[2] * wall > 0;
            if (!deep) saltation(&run, wall ? -1 : 1);
            new_instant(&run);
            if (wall) {
                begun++;
                if (!deep) run.origin = wall * p.clearance;
                begin_contact(&run, wall, contacts, &logged);
            } else {
                contacts[5 * logged - 3] = run.t;
                contacts[5 * logged - 1] = run.y[3];
            }
            if (!deep) run.y[2] = 0;
            run.side = wall;
        }
        real *y = states + 4 * i;
        memcpy(y, run.y, sizeof run.y);
        y[2] += run.origin;
        if (i + 1 < n) new_instant(&run);
    }
    if (isfinite(p.clearance)) note_turning(&run, run.t, run.y[2], run.since.m[2]);
    *growth = 1;
    for (long i = 0; i < run.instants; i++) {
        Matrix whole = product(&run.since, &run.flows[i]);
        if (i == 0) memcpy(flow, whole.m, sizeof whole.m);
        for (int k = 0; k < 4; k++) *growth = fmaxl(*growth, row_sum(whole.m[k]));
    }
    counts[0] = begun, counts[1] = logged, counts[2] = run.turning_count;
    return run.status;
}
