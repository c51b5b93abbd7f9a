// An XPBD cloth that falls on a ball and passes through nothing: python/examples/cloth_xpbd.py in
// C++17. Near pairs push surfaces apart. Contacts then limit each vertex, until the step is free.
//
//     cloth_xpbd [cells a side, default 24] [frames, default 400]

#include "nearmiss.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace {

constexpr double RADIUS = 0.25, STEP = 0.01, GRAVITY = 9.81; // metres, seconds
constexpr double FRICTION = 0.3, DAMPING = 2.0;              // damping a second
constexpr double BENDING = 2e-3;                             // compliance, seconds squared
constexpr int ATTEMPTS = 8;
// In cells, below the distance of opposite parts of a cell: a flat cloth has no near pairs.
constexpr double THICKNESS = 0.15, REACH = 0.25;

struct Point {
    double x, y, z;
};
Point operator+(Point a, Point b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Point operator-(Point a, Point b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Point operator*(double s, Point a) { return {s * a.x, s * a.y, s * a.z}; }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(Point a) { return std::sqrt(dot(a, a)); }
using Points = std::vector<Point>;
using Triangles = std::vector<std::array<uint32_t, 3>>;

// Handles that free themselves.
template <typename T, void (*Free)(T *)> struct Freed {
    void operator()(T *handle) const { Free(handle); }
};
using Device = std::unique_ptr<NearmissDevice, Freed<NearmissDevice, nearmiss_device_free>>;
using Scene = std::unique_ptr<NearmissScene, Freed<NearmissScene, nearmiss_scene_free>>;
using Detector = std::unique_ptr<NearmissDetector, Freed<NearmissDetector, nearmiss_detector_free>>;
using Answer = std::unique_ptr<NearmissAnswer, Freed<NearmissAnswer, nearmiss_answer_free>>;

void check(NearmissCode code, const NearmissError &error)
{
    if (code != NEARMISS_OK)
        throw std::runtime_error(error.text);
}

NearmissRows rows(const Points &points) { return nearmiss_doubles(&points[0].x, points.size()); }

// A square of side 1 above the ball, a little off its centre and wavy.
void make_cloth(uint32_t cells, Points &points, Triangles &triangles)
{
    const uint32_t row = cells + 1;
    for (uint32_t i = 0; i < row; i++)
        for (uint32_t j = 0; j < row; j++) {
            const double x = double(i) / cells, y = double(j) / cells;
            points.push_back({x - 0.48, y - 0.51, RADIUS + 0.12 + 0.01 * std::sin(7 * x + 3 * y)});
        }
    for (uint32_t i = 0; i < cells; i++)
        for (uint32_t j = 0; j < cells; j++) {
            const uint32_t a = i * row + j, b = a + row, c = a + 1, d = b + 1;
            triangles.push_back({a, b, c});
            triangles.push_back({b, d, c});
        }
}

// An octahedron whose triangles are cut in four, several times, and whose vertices are on a sphere.
void make_ball(int levels, Points &points, Triangles &triangles)
{
    points = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2},
                 {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
    for (int level = 0; level < levels; level++) {
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
        const auto middle = [&](uint32_t a, uint32_t b) {
            const auto [at, is_new] =
                middles.try_emplace(std::minmax(a, b), uint32_t(points.size()));
            if (is_new) {
                const Point sum = points[a] + points[b];
                points.push_back(1 / length(sum) * sum);
            }
            return at->second;
        };
        Triangles cut;
        for (const auto &[a, b, c] : triangles) {
            const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            cut.insert(cut.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        triangles = cut;
    }
    for (Point &point : points)
        point = RADIUS * point;
}

struct Spring {
    uint32_t a, b;
    double rest, compliance, multiplier;
};

// Iterations of a step: with more cells a pull takes more of them to cross the cloth.
int iterations_for(uint32_t cells) { return 20 * std::max(1, int(std::lround(cells / 75.0))); }

std::vector<Spring> make_springs(uint32_t cells, const Points &x)
{
    std::vector<Spring> springs;
    const int row = int(cells) + 1, ways[6][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}, {2, 0}, {0, 2}};
    for (const auto &[right, up] : ways)
        for (int i = 0; i + right < row; i++)
            for (int j = std::max(0, -up); j + std::max(0, up) < row; j++) {
                const uint32_t a = uint32_t(i * row + j), b = uint32_t((i + right) * row + j + up);
                const double compliance = std::max(right, up) == 2 ? BENDING / (STEP * STEP) : 0;
                springs.push_back({a, b, length(x[a] - x[b]), compliance, 0});
            }
    return springs;
}

// A near pair: four vertices of cloth and ball, signed weights, normal, and the distance to keep.
struct Contact {
    uint32_t vertices[4];
    double weights[4];
    Point normal;
    double wanted;
};

class Cloth {
  public:
    Points x, v;
    size_t own; // vertices of the cloth; those of the ball follow them in `x`
    uint64_t crossing = 0;

    explicit Cloth(uint32_t cells)
        : thickness(THICKNESS / cells), reach(REACH / cells), iterations(iterations_for(cells))
    {
        Triangles triangles, ball_triangles;
        Points ball;
        make_cloth(cells, x, triangles);
        make_ball(4, ball, ball_triangles);
        own = x.size();
        v.assign(own, {0, 0, 0});
        springs = make_springs(cells, x);

        NearmissDevice *opened = nullptr;
        check(nearmiss_device_open(NEARMISS_AUTO, 0, &opened, &error), error);
        device.reset(opened);
        NearmissScene *begun = nullptr;
        check(nearmiss_scene_create(&begun, &error), error);
        const Scene scene(begun);
        id = add(scene.get(), "cloth", x, triangles, NEARMISS_BODY_DEFORMABLE);
        add(scene.get(), "ball", ball, ball_triangles, NEARMISS_BODY_FIXED);
        NearmissDetector *made = nullptr;
        check(nearmiss_detector_create(device.get(), scene.get(), &made, &error), error);
        detector.reset(made);
        x.insert(x.end(), ball.begin(), ball.end());
    }

    // Moves by one step; returns the share of vertices that were limited.
    double frame()
    {
        Points goal = solve(contacts());
        const size_t limited = limit(goal);
        for (size_t i = 0; i < own; i++)
            v[i] = (1 - DAMPING * STEP) / STEP * (goal[i] - x[i]);
        x = goal;
        return double(limited) / double(own);
    }

    bool is_free()
    {
        const NearmissMotion motion = nearmiss_motion_positions(id, cloth_rows(x));
        const Answer answer = query(motion, nearmiss_query(NEARMISS_DISCRETE));
        bool is_free = false;
        check(nearmiss_answer_is_free(answer.get(), &is_free, &error), error);
        return is_free;
    }

  private:
    double thickness, reach;
    int iterations;
    std::vector<Spring> springs;
    uint32_t id = 0;
    NearmissError error;
    Device device;
    Detector detector;

    uint32_t add(NearmissScene *scene, const char *name, const Points &points,
                 const Triangles &triangles, NearmissBodyKind kind)
    {
        NearmissBody body = nearmiss_body();
        body.name = name;
        body.positions = rows(points);
        body.triangles = triangles[0].data();
        body.triangle_count = triangles.size();
        body.kind = kind;
        uint32_t number = 0;
        check(nearmiss_scene_add(scene, &body, &number, &error), error);
        return number;
    }

    NearmissRows cloth_rows(const Points &points) const
    {
        return nearmiss_doubles(&points[0].x, own);
    }

    Answer query(const NearmissMotion &motion, const NearmissQuery &query)
    {
        NearmissAnswer *made = nullptr;
        check(nearmiss_detector_step(detector.get(), &motion, 1, &query, &made, &error), error);
        return Answer(made);
    }

    std::vector<Contact> contacts()
    {
        NearmissQuery near = nearmiss_query(NEARMISS_NEAR);
        near.distance = reach;
        const Answer answer = query(nearmiss_motion_positions(id, cloth_rows(x)), near);
        const NearmissGeometry *where = nullptr;
        size_t count = 0;
        check(nearmiss_detector_geometry(detector.get(), answer.get(), &where, &count, &error),
              error);
        std::vector<Contact> found(count);
        for (size_t i = 0; i < count; i++) {
            for (size_t k = 0; k < 4; k++) {
                const bool is_own = where[i].owner[k] == id;
                found[i].vertices[k] = where[i].vertices[k] + (is_own ? 0 : uint32_t(own));
                found[i].weights[k] = where[i].signed_weights[k];
            }
            found[i].normal = {where[i].normal[0], where[i].normal[1], where[i].normal[2]};
            // A pair that is too near is moved apart over several steps: a push is a velocity.
            found[i].wanted = std::min(thickness, where[i].distance + 0.2 * thickness);
        }
        return found;
    }

    // The wanted end of the step.
    Points solve(const std::vector<Contact> &contacts)
    {
        Points goal = x;
        for (size_t i = 0; i < own; i++)
            goal[i] = x[i] + STEP * v[i] + Point{0, 0, -GRAVITY * STEP * STEP};
        for (Spring &spring : springs)
            spring.multiplier = 0;
        for (int iteration = 0; iteration < iterations; iteration++) {
            for (auto &[a, b, rest, compliance, multiplier] : springs) {
                const Point along = goal[a] - goal[b];
                const double now = length(along);
                const double change = (rest - now - compliance * multiplier) / (2 + compliance);
                multiplier += change;
                goal[a] = goal[a] + change / now * along;
                goal[b] = goal[b] - change / now * along;
            }
            for (const Contact &contact : contacts)
                push_apart(contact, goal);
        }
        return goal;
    }

    // Moves a pair that is nearer than wanted apart, and holds it by friction.
    void push_apart(const Contact &contact, Points &goal) const
    {
        Point apart{0, 0, 0}, before{0, 0, 0};
        double mass = 0;
        for (size_t k = 0; k < 4; k++) {
            const uint32_t vertex = contact.vertices[k];
            const double weight = contact.weights[k];
            apart = apart + weight * goal[vertex];
            before = before + weight * x[vertex];
            mass += vertex < own ? weight * weight : 0;
        }
        const double depth = contact.wanted - dot(apart, contact.normal);
        if (depth <= 0 || mass == 0)
            return;
        Point slide = apart - before;
        slide = slide - dot(slide, contact.normal) * contact.normal;
        const double way = length(slide);
        const double held = way > 0 ? std::min(1.0, FRICTION * depth / way) : 0;
        const Point push = 1 / mass * (depth * contact.normal - held * slide);
        for (size_t k = 0; k < 4; k++)
            if (contact.vertices[k] < own)
                goal[contact.vertices[k]] = goal[contact.vertices[k]] + contact.weights[k] * push;
    }

    // Limits each vertex by its contacts until the step to the goal is free; returns how many are
    // limited. A vertex that meets something after many attempts rests in this step.
    size_t limit(Points &goal)
    {
        const Points wanted = goal;
        const NearmissQuery continuous = nearmiss_query(NEARMISS_CONTINUOUS);
        std::vector<double> part(own, 1.0);
        for (int attempt = 0;; attempt++) {
            for (size_t i = 0; i < own; i++)
                goal[i] = x[i] + part[i] * (wanted[i] - x[i]);
            const NearmissMotion motion = nearmiss_motion_step(id, cloth_rows(x), cloth_rows(goal));
            const Answer answer = query(motion, continuous);
            NearmissSummary summary;
            check(nearmiss_answer_summary(answer.get(), &summary, &error), error);
            crossing += summary.starts_crossing;
            const NearmissContact *found = nullptr;
            const NearmissGeometry *where = nullptr;
            size_t count = 0;
            check(nearmiss_answer_contacts(answer.get(), &found, &count, &error), error);
            check(nearmiss_detector_geometry(detector.get(), answer.get(), &where, &count, &error),
                  error);
            std::vector<double> least(own, 1.0);
            bool moves = false;
            for (size_t i = 0; i < count; i++)
                for (size_t k = 0; k < 4; k++) {
                    const uint32_t vertex = where[i].vertices[k];
                    if (where[i].owner[k] != id || part[vertex] == 0)
                        continue;
                    moves = true;
                    least[vertex] =
                        std::min(least[vertex], attempt < ATTEMPTS ? 0.9 * found[i].toi : 0);
                }
            if (!moves) // vertices at rest pass through nothing
                return size_t(
                    std::count_if(part.begin(), part.end(), [](double p) { return p < 1; }));
            for (size_t i = 0; i < own; i++)
                part[i] *= least[i];
        }
    }
};

int run(uint32_t cells, int frames)
{
    if (nearmiss_abi() != NEARMISS_ABI)
        throw std::runtime_error(std::string("the header is not that of the library ") +
                                 nearmiss_version());
    Cloth cloth(cells);
    double most_kinetic = 0, kinetic = 0, first_energy = 0, energy = 0, limited = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (int frame = 0; frame < frames; frame++) {
        const double share = cloth.frame();
        // The last tenth of the run is the cloth at rest.
        limited = frame < frames - frames / 10 ? 0 : std::max(limited, share);
        kinetic = energy = 0;
        for (size_t i = 0; i < cloth.own; i++) {
            kinetic += dot(cloth.v[i], cloth.v[i]) / 2 / double(cloth.own);
            energy += GRAVITY * cloth.x[i].z / double(cloth.own);
        }
        energy += kinetic;
        first_energy = frame == 0 ? energy : first_energy;
        most_kinetic = std::max(most_kinetic, kinetic);
    }
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - begin;
    const auto lower = [](Point a, Point b) { return a.z < b.z; };
    const auto [low, high] =
        std::minmax_element(cloth.x.begin(), cloth.x.begin() + std::ptrdiff_t(cloth.own), lower);
    std::printf("%u triangles, %.1f ms a frame; energy %.3f to %.3f J/kg, kinetic at the end %.1e, "
                "limited vertices at the end %.1f %%\n",
                2 * cells * cells, taken.count() / frames, first_energy, energy, kinetic,
                100 * limited);
    const std::pair<const char *, bool> checks[] = {
        {"triangles cross", cloth.crossing == 0 && cloth.is_free()},
        {"energy does not fall", energy < first_energy - 0.1 * GRAVITY},
        {"the cloth has not come to rest", kinetic < 0.01 * most_kinetic},
        {"the cloth is frozen", limited < 0.01},
        {"the cloth is not on the ball", high->z > RADIUS && high->z < 1.2 * RADIUS},
        {"the cloth does not hang", low->z < -0.5 * RADIUS},
    };
    int faults = 0;
    for (const auto &[fault, is_good] : checks)
        if (!is_good) {
            std::fprintf(stderr, "%s\n", fault);
            faults++;
        }
    return faults == 0 ? 0 : 1;
}

} // namespace

int main(int count, char **arguments)
{
    try {
        const long cells = count > 1 ? std::strtol(arguments[1], nullptr, 10) : 24;
        const long frames = count > 2 ? std::strtol(arguments[2], nullptr, 10) : 400;
        if (cells < 2 || cells > 1000)
            throw std::runtime_error("cells must be 2 to 1000, got " + std::to_string(cells) +
                                     "; pass a number of that range");
        if (frames < 10)
            throw std::runtime_error("frames must be at least 10, got " + std::to_string(frames) +
                                     "; pass more");
        return run(uint32_t(cells), int(frames));
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
