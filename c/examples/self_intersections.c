/* Crossing triangles of a mesh. C99. */

#include "nearmiss.h"

#include <stdio.h>

/* A strip of two triangles that is flat, and another that stands through it. */
static const float points[8][3] = {
    {0, 0, 0},    {4, 0, 0},    {0, 4, 0},   {4, 4, 0},
    {1, 1, -0.5f}, {3, 1, -0.5f}, {1, 1, 0.5f}, {3, 1, 0.5f},
};
static const uint32_t triangles[4][3] = {{0, 1, 2}, {1, 3, 2}, {4, 5, 6}, {5, 7, 6}};

int main(void)
{
    NearmissError error;
    NearmissDevice *device = NULL;
    NearmissScene *scene = NULL;
    NearmissDetector *detector = NULL;
    NearmissAnswer *answer = NULL;
    const NearmissTrianglePair *pairs = NULL;
    size_t count = 0, i;
    NearmissQuery query;
    NearmissBody body;
    int failed = 1;

    /* Before any call that takes or returns a struct. */
    if (nearmiss_abi() != NEARMISS_ABI) {
        fprintf(stderr, "the header is not that of the library %s\n", nearmiss_version());
        return 1;
    }
    query = nearmiss_query(NEARMISS_DISCRETE);
    body = nearmiss_body();
    body.name = "two strips";
    body.positions = nearmiss_floats(&points[0][0], 8);
    body.triangles = &triangles[0][0];
    body.triangle_count = 4;
    error.code = NEARMISS_OK;
    if (nearmiss_device_open(NEARMISS_AUTO, 0, &device, &error) == NEARMISS_OK
        && nearmiss_scene_create(&scene, &error) == NEARMISS_OK
        && nearmiss_scene_add(scene, &body, NULL, &error) == NEARMISS_OK
        && nearmiss_detector_create(device, scene, &detector, &error) == NEARMISS_OK
        && nearmiss_detector_query(detector, &query, &answer, &error) == NEARMISS_OK
        && nearmiss_answer_triangle_pairs(answer, &pairs, &count, &error) == NEARMISS_OK) {
        printf("%u pairs\n", (unsigned)count);
        for (i = 0; i < count; i++)
            printf("%u and %u\n", (unsigned)pairs[i].triangles[0], (unsigned)pairs[i].triangles[1]);
        /* Both standing triangles cross the first flat one. The second of them ends in the diagonal, so it touches the other. */
        failed = count != 3;
    } else {
        fprintf(stderr, "code %u: %s\n", (unsigned)error.code, error.text);
    }
    nearmiss_answer_free(answer);
    nearmiss_detector_free(detector);
    nearmiss_scene_free(scene);
    nearmiss_device_free(device);
    return failed;
}
