// Motions with contacts by Boost.odeint: runge_kutta_dopri5 with dense output. A contact begins or
// ends in a step at whose end the loose mass is on the other side of the wall; bisection of the
// dense output finds the time. This is the manner of odeint's documentation, "Using dense output
// for events". A contact that begins and ends within a step is missed.

#include <array>
#include <boost/numeric/odeint.hpp>
#include <cmath>

namespace {

using State = std::array<double, 4>;

struct Motion {
    double damping, stiffness, cubic, amplitude, frequency, clearance, wall, dashpot, heavy;
    double lag, base, gravity;  // lag: dashpot / wall if walls never pull, otherwise 0
    int side;  // -1 or 1 in contact, 0 in flight

    void operator()(const State &y, State &rates, double t) const {
        const double x = y[0], v = y[1], z = y[2], w = y[3];
        const double drive = amplitude * std::cos(frequency * t);
        const double free = drive - damping * v - (stiffness + cubic * x * x) * x;
        const double force = side ? wall * (z - side * clearance) + dashpot * w : 0.0;
        rates = {v, free - force, w, free - base * drive + gravity - heavy * force};
    }

    // Whether a state has left the present phase: no wall pressed in contact, or a wall in flight.
    bool changed(const State &y) const {
        const double depth = std::abs(y[2]) - clearance;
        const bool pushed = depth > 0 && depth + lag * std::copysign(std::abs(y[3]), y[2] * y[3]) > 0;
        return side ? !pushed : pushed;
    }
};

// The largest displacement after the time `lead`, from SAMPLES states within each step.
struct Peak {
    static constexpr int SAMPLES = 4;
    double lead, size = 0.0;

    template <class Stepper> void look(Stepper &stepper, double first, double last) {
        State y;
        for (int i = 1; i <= SAMPLES && last > lead; ++i) {
            stepper.calc_state(first + (last - first) * i / SAMPLES, y);
            size = std::max(size, std::abs(y[0]));
        }
    }
};

// Advance a state from the time t to `end` and return the number of contacts begun.
long advance(Motion motion, State &y, double t, double end, double tolerance, Peak *peak = nullptr) {
    using namespace boost::numeric::odeint;
    auto stepper = make_dense_output(tolerance, tolerance, runge_kutta_dopri5<State>());
    long contacts = 0;
    double step = 1e-3;
    stepper.initialize(y, t, step);
    while (true) {
        stepper.do_step(motion);
        double first = stepper.previous_time(), last = std::min(stepper.current_time(), end);
        stepper.calc_state(last, y);
        if (!motion.changed(y)) {
            if (peak) peak->look(stepper, first, last);
            if (last == end) return contacts;
            continue;
        }
        while (true) {
            const double middle = first + (last - first) / 2;
            if (middle <= first || middle >= last) break;
            stepper.calc_state(middle, y);
            (motion.changed(y) ? last : first) = middle;
        }
        if (peak) peak->look(stepper, stepper.previous_time(), last);
        stepper.calc_state(last, y);
        motion.side = motion.side ? 0 : (y[2] > 0 ? 1 : -1);
        contacts += motion.side != 0;
        stepper.initialize(y, last, step);
    }
}

Motion from(const double *given) {
    return {given[0], given[1], given[2], given[3], given[4], given[5], given[6], given[7],
            given[8], given[9], given[10], given[11], 0};
}

}  // namespace

// `given` holds the members of Motion in order, without `side`.
extern "C" void motions(
    const double *given, long count, double begin, double end, double tolerance, double *states,
    long *contacts) {
    for (long i = 0; i < count; ++i) {
        State y;
        std::copy(states + 4 * i, states + 4 * i + 4, y.begin());
        contacts[i] = advance(from(given), y, begin, end, tolerance);
        std::copy(y.begin(), y.end(), states + 4 * i);
    }
}

// The largest displacement of each motion from the time `lead` to `end`.
extern "C" void largest(
    const double *given, long count, double begin, double lead, double end, double tolerance,
    const double *states, double *sizes) {
    for (long i = 0; i < count; ++i) {
        State y;
        std::copy(states + 4 * i, states + 4 * i + 4, y.begin());
        Peak peak{lead};
        advance(from(given), y, begin, end, tolerance, &peak);
        sizes[i] = peak.size;
    }
}
