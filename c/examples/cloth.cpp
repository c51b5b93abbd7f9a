// A cloth of masses and springs that falls on the ground and passes through nothing. One detector
// answers three queries: contacts limit each step vertex by vertex, near pairs count what touches,
// crossing triangles prove the result. C++17.

#include "nearmiss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Point = std::array<double, 3>;

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

constexpr int SIDE = 12;             // squares
constexpr double SPACE = 1.0 / SIDE; // between neighbours
constexpr double STEP = 1.0 / 240;   // seconds
constexpr int STEPS = 240;

struct Sheet {
    std::vector<Point> points;
    std::vector<std::array<uint32_t, 3>> triangles;
};

template <typename At> Sheet sheet(int side, At at)
{
    Sheet made;
    for (int i = 0; i <= side; i++)
        for (int j = 0; j <= side; j++)
            made.points.push_back(at(double(i) / side, double(j) / side));
    for (int i = 0; i < side; i++)
        for (int j = 0; j < side; j++) {
            const uint32_t a = uint32_t(i * (side + 1) + j), b = a + 1, c = a + uint32_t(side) + 1, d = c + 1;
            made.triangles.push_back({a, b, c});
            made.triangles.push_back({b, d, c});
        }
    return made;
}

uint32_t add(NearmissScene *scene, const char *name, const Sheet &mesh, NearmissBodyKind kind)
{
    NearmissError error;
    NearmissBody body = nearmiss_body();
    body.name = name;
    body.positions = nearmiss_doubles(mesh.points[0].data(), mesh.points.size());
    body.triangles = mesh.triangles[0].data();
    body.triangle_count = mesh.triangles.size();
    body.kind = kind;
    uint32_t id = 0;
    check(nearmiss_scene_add(scene, &body, &id, &error), error);
    return id;
}

// Velocities after a step of springs and gravity.
void forces(const std::vector<Point> &x, std::vector<Point> &v)
{
    constexpr double STIFF = 4000, DAMP = 2;
    const int row = SIDE + 1;
    for (Point &of : v) {
        of[2] -= 9.81 * STEP;
        for (double &part : of)
            part *= 1 - DAMP * STEP;
    }
    const int ways[4][2] = {{0, 1}, {1, 0}, {1, 1}, {1, -1}};
    for (int i = 0; i < row; i++)
        for (int j = 0; j < row; j++)
            for (const auto &way : ways) {
                const int p = i + way[0], q = j + way[1];
                if (p >= row || q >= row || q < 0)
                    continue;
                const size_t a = size_t(i * row + j), b = size_t(p * row + q);
                Point d;
                for (int k = 0; k < 3; k++)
                    d[size_t(k)] = x[b][size_t(k)] - x[a][size_t(k)];
                const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
                const double rest = SPACE * std::sqrt(double(way[0] * way[0] + way[1] * way[1]));
                const double pull = STIFF * (length - rest) / std::max(length, 1e-9) * STEP;
                for (size_t k = 0; k < 3; k++) {
                    v[a][k] += pull * d[k];
                    v[b][k] -= pull * d[k];
                }
            }
}

// The answer to a query of the bodies where they are.
Answer ask(NearmissDetector *detector, const NearmissQuery &query)
{
    NearmissError error;
    NearmissAnswer *made = nullptr;
    check(nearmiss_detector_query(detector, &query, &made, &error), error);
    return Answer(made);
}

// Shortens the step from `from` to `to` until nothing collides; returns the number of queries. A
// vertex that collides stops at nine tenths of the way to its own first contact, and stays where it
// was if it collides again. The loop ends: each round holds a vertex more.
int limit(NearmissDetector *detector, const NearmissQuery &query, uint32_t cloth, const std::vector<Point> &from,
          std::vector<Point> &to)
{
    NearmissError error;
    std::vector<int> met(from.size(), 0);
    for (int queries = 1;; queries++) {
        const NearmissMotion motion = nearmiss_motion_step(cloth, nearmiss_doubles(from[0].data(), from.size()),
                                                           nearmiss_doubles(to[0].data(), to.size()));
        NearmissAnswer *made = nullptr;
        check(nearmiss_detector_step(detector, &motion, 1, &query, &made, &error), error);
        const Answer answer(made);
        const NearmissContact *contacts = nullptr;
        const NearmissGeometry *where = nullptr;
        size_t count = 0;
        check(nearmiss_answer_contacts(answer.get(), &contacts, &count, &error), error);
        check(nearmiss_detector_geometry(detector, answer.get(), &where, &count, &error), error);
        std::vector<double> part(from.size(), 1.0);
        bool moves = false;
        for (size_t i = 0; i < count; i++)
            for (size_t k = 0; k < 4; k++) {
                const uint32_t vertex = where[i].vertices[k];
                if (where[i].owner[k] != cloth || met[vertex] > 1)
                    continue;
                moves = true;
                part[vertex] = std::min(part[vertex], met[vertex] == 0 ? 0.9 * contacts[i].toi : 0.0);
            }
        if (!moves)
            return queries;
        for (size_t v = 0; v < from.size(); v++)
            if (part[v] < 1.0) {
                met[v]++;
                for (size_t k = 0; k < 3; k++)
                    to[v][k] = part[v] == 0.0 ? from[v][k] : from[v][k] + part[v] * (to[v][k] - from[v][k]);
                if (part[v] == 0.0)
                    met[v] = 2;
            }
    }
}

int run()
{
    if (nearmiss_abi() != NEARMISS_ABI)
        throw std::runtime_error(std::string("the header is not that of the library ") + nearmiss_version());
    NearmissError error;
    NearmissDevice *opened = nullptr;
    check(nearmiss_device_open(NEARMISS_AUTO, 0, &opened, &error), error);
    const Device device(opened);
    NearmissScene *begun = nullptr;
    check(nearmiss_scene_create(&begun, &error), error);
    const Scene scene(begun);
    const Sheet cloth = sheet(SIDE, [](double x, double y) { return Point{x, y, 0.1 + 0.2 * x * y}; });
    const Sheet ground = sheet(4, [](double x, double y) { return Point{4 * x - 1.5, 4 * y - 1.5, 0}; });
    const uint32_t id = add(scene.get(), "cloth", cloth, NEARMISS_BODY_DEFORMABLE);
    add(scene.get(), "ground", ground, NEARMISS_BODY_FIXED);
    NearmissDetector *made = nullptr;
    check(nearmiss_detector_create(device.get(), scene.get(), &made, &error), error);
    const Detector detector(made);
    NearmissQuery contacts = nearmiss_query(NEARMISS_CONTINUOUS);
    contacts.tolerance = 1e-6;

    std::vector<Point> x = cloth.points, v(x.size(), Point{0, 0, 0});
    int queries = 0, limited = 0;
    for (int step = 0; step < STEPS; step++) {
        forces(x, v);
        std::vector<Point> to = x;
        for (size_t i = 0; i < x.size(); i++)
            for (size_t k = 0; k < 3; k++)
                to[i][k] += STEP * v[i][k];
        const int rounds = limit(detector.get(), contacts, id, x, to);
        queries += rounds;
        limited += rounds > 1;
        for (size_t i = 0; i < x.size(); i++)
            for (size_t k = 0; k < 3; k++)
                v[i][k] = (to[i][k] - x[i][k]) / STEP;
        x = to;
    }
    double least = 1, most = -1;
    for (const Point &p : x) {
        least = std::min(least, p[2]);
        most = std::max(most, p[2]);
    }
    const NearmissMotion rest = nearmiss_motion_positions(id, nearmiss_doubles(x[0].data(), x.size()));
    check(nearmiss_detector_update(detector.get(), &rest, 1, &error), error);
    // Fewer pairs within a smaller distance; nothing is rebuilt between these two.
    NearmissQuery near = nearmiss_query(NEARMISS_NEAR);
    size_t touching[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        near.distance = k == 0 ? 0.01 : 0.0001;
        const Answer answer = ask(detector.get(), near);
        const NearmissNearPair *pairs = nullptr;
        check(nearmiss_answer_near_pairs(answer.get(), &pairs, &touching[k], &error), error);
    }
    bool is_free = false;
    const Answer crossing = ask(detector.get(), nearmiss_query(NEARMISS_DISCRETE));
    check(nearmiss_answer_is_free(crossing.get(), &is_free, &error), error);
    std::printf("%d steps, %d limited, %d queries; heights %g to %g\n", STEPS, limited, queries, least, most);
    std::printf("%zu pairs within 0.01, %zu within 0.0001; %s\n", touching[0], touching[1],
                is_free ? "nothing crosses" : "triangles cross");
    // A comparison with NaN is false.
    const bool rests = least >= 0 && least < 0.01 && most < 0.3 && limited > 0;
    const bool is_right = rests && is_free && touching[1] < touching[0];
    if (!is_right)
        std::fprintf(stderr, "the cloth does not rest on the ground\n");
    return is_right ? 0 : 1;
}

} // namespace

int main()
{
    try {
        return run();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
