// A cloth of masses and springs that falls on the ground. No step goes through anything: each is asked about, and what would
// meet stops before it does. C++17.

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

uint32_t add(NearmissScene *scene, const char *name, const Sheet &mesh, NearmissBodyKind kind, bool self_collision)
{
    NearmissError error;
    NearmissBody body = nearmiss_body();
    body.name = name;
    body.positions = nearmiss_doubles(mesh.points[0].data(), mesh.points.size());
    body.triangles = mesh.triangles[0].data();
    body.triangle_count = mesh.triangles.size();
    body.kind = kind;
    body.self_collision = self_collision ? NEARMISS_SELF_COLLISION_ON : NEARMISS_SELF_COLLISION_OFF;
    uint32_t id = 0;
    check(nearmiss_scene_add(scene, &body, &id, &error), error);
    return id;
}

// Where springs and gravity would take the cloth.
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

// Goes from `from` towards `to` as far as nothing meets; returns how often it asked. What meets stops at nine tenths of the way to
// it, and stays where it was if it meets something even so. It ends: each time a vertex more is held, or nothing meets that moves.
int limit(NearmissDetector *detector, uint32_t cloth, const std::vector<Point> &from, std::vector<Point> &to)
{
    NearmissError error;
    std::vector<int> met(from.size(), 0);
    for (int asked = 1;; asked++) {
        const NearmissInput input = nearmiss_step(cloth, nearmiss_doubles(from[0].data(), from.size()),
                                                  nearmiss_doubles(to[0].data(), to.size()));
        NearmissAnswer *made = nullptr;
        check(nearmiss_detector_frame(detector, &input, 1, &made, &error), error);
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
                if (where[i].bodies[k < where[i].first ? 0 : 1] != cloth || met[vertex] > 1)
                    continue;
                moves = true;
                part[vertex] = std::min(part[vertex], met[vertex] == 0 ? 0.9 * contacts[i].toi : 0.0);
            }
        if (!moves)
            return asked;
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
    check(nearmiss_scene_new(&begun, &error), error);
    const Scene scene(begun);
    const Sheet cloth = sheet(SIDE, [](double x, double y) { return Point{x, y, 0.1 + 0.2 * x * y}; });
    const Sheet ground = sheet(4, [](double x, double y) { return Point{4 * x - 1.5, 4 * y - 1.5, 0}; });
    const uint32_t id = add(scene.get(), "cloth", cloth, NEARMISS_DEFORMABLE, true);
    add(scene.get(), "ground", ground, NEARMISS_FIXED, false);
    NearmissQuery query = nearmiss_query(NEARMISS_CONTINUOUS);
    query.tolerance = 1e-6;
    NearmissDetector *made = nullptr;
    check(nearmiss_detector_new(device.get(), scene.get(), &query, &made, &error), error);
    const Detector detector(made);

    std::vector<Point> x = cloth.points, v(x.size(), Point{0, 0, 0});
    int asked = 0, held = 0;
    for (int step = 0; step < STEPS; step++) {
        forces(x, v);
        std::vector<Point> to = x;
        for (size_t i = 0; i < x.size(); i++)
            for (size_t k = 0; k < 3; k++)
                to[i][k] += STEP * v[i][k];
        const int times = limit(detector.get(), id, x, to);
        asked += times;
        held += times > 1;
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
    std::printf("%d steps, %d limited, %d questions; heights %g to %g\n", STEPS, held, asked, least, most);
    // Written so that what is no number fails too.
    const bool lies = least >= 0 && least < 0.01 && most < 0.3 && held > 0;
    if (!lies)
        std::fprintf(stderr, "the cloth does not lie on the ground\n");
    return lies ? 0 : 1;
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
