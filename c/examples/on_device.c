/* A simulator whose vertices never leave the GPU. Its kernel moves them, and two queries of one
 * detector follow on the same stream. A graph records all three and is launched a thousand times.
 * Each answer is compared with the CPU's. C99, and CUDA's driver by its public names: no toolkit.
 * It ends with 77 if there is no GPU. */

#include "nearmiss.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 60, VERTICES = (SIDE + 1) * (SIDE + 1), TRIANGLES = 2 * SIDE * SIDE, NUMBERS = 3 * VERTICES, FRAMES = 1000 };
#define BYTES (NUMBERS * sizeof(float))

/* The end of the last step becomes the start of this one, and the vertex moves on. */
static const char kernel[] =
    ".version 7.5\n.target sm_80\n.address_size 64\n"
    ".visible .entry move(.param .u64 t0, .param .u64 t1, .param .u64 velocity, .param .u32 count)\n"
    "{\n.reg .u32 %r<5>;\n.reg .u64 %d<7>;\n.reg .f32 %f<3>;\n.reg .pred %p;\n"
    "mov.u32 %r0, %ctaid.x;\nmov.u32 %r1, %ntid.x;\nmov.u32 %r2, %tid.x;\nmad.lo.u32 %r3, %r0, %r1, %r2;\n"
    "ld.param.u32 %r4, [count];\nsetp.ge.u32 %p, %r3, %r4;\n@%p bra done;\n"
    "ld.param.u64 %d0, [t0];\nld.param.u64 %d1, [t1];\nld.param.u64 %d2, [velocity];\nmul.wide.u32 %d3, %r3, 4;\n"
    "add.u64 %d4, %d0, %d3;\nadd.u64 %d5, %d1, %d3;\nadd.u64 %d6, %d2, %d3;\n"
    "ld.global.f32 %f0, [%d5];\nld.global.f32 %f1, [%d6];\nst.global.f32 [%d4], %f0;\n"
    "add.rn.f32 %f2, %f0, %f1;\nst.global.f32 [%d5], %f2;\ndone:\nret;\n}\n";

typedef void *Handle;
typedef unsigned long long Address;

/* Functions of the driver. */
static struct {
    int (*init)(unsigned), (*device)(int *, int), (*context)(Handle *, unsigned, int), (*stream)(Handle *, unsigned);
    int (*load)(Handle *, const void *), (*function)(Handle *, Handle, const char *), (*allocate)(Address *, size_t);
    int (*up)(Address, const void *, size_t), (*synchronize)(Handle);
    int (*launch)(Handle, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, unsigned, Handle, void **, void **);
    int (*begin)(Handle, int), (*end)(Handle, Handle *), (*nodes)(Handle, Handle *, size_t *), (*type)(Handle, int *);
    int (*instantiate)(Handle *, Handle, unsigned long long), (*replay)(Handle, Handle);
} cu;

static int open_driver(void)
{
    const struct {
        const char *name;
        void *to;
    } all[] = {
        {"cuInit", &cu.init},
        {"cuDeviceGet", &cu.device},
        {"cuCtxCreate_v2", &cu.context},
        {"cuStreamCreate", &cu.stream},
        {"cuModuleLoadData", &cu.load},
        {"cuModuleGetFunction", &cu.function},
        {"cuMemAlloc_v2", &cu.allocate},
        {"cuMemcpyHtoD_v2", &cu.up},
        {"cuStreamSynchronize", &cu.synchronize},
        {"cuLaunchKernel", &cu.launch},
        {"cuStreamBeginCapture_v2", &cu.begin},
        {"cuStreamEndCapture", &cu.end},
        {"cuGraphGetNodes", &cu.nodes},
        {"cuGraphNodeGetType", &cu.type},
        {"cuGraphInstantiateWithFlags", &cu.instantiate},
        {"cuGraphLaunch", &cu.replay},
    };
    void *driver = dlopen("libcuda.so.1", RTLD_NOW);
    size_t i;
    if (driver == NULL)
        return 0;
    for (i = 0; i < sizeof all / sizeof *all; i++) {
        void *found = dlsym(driver, all[i].name);
        if (found == NULL)
            return 0;
        memcpy(all[i].to, &found, sizeof found);
    }
    return cu.init(0) == 0;
}

static void cuda(int result, const char *what)
{
    if (result != 0) {
        fprintf(stderr, "%s: CUDA's error %d\n", what, result);
        exit(1);
    }
}

static NearmissError error;

static void check(NearmissCode code)
{
    if (code != NEARMISS_OK) {
        fprintf(stderr, "%s\n", error.text);
        exit(1);
    }
}

static float at[2][NUMBERS], velocity[NUMBERS];
static uint32_t triangles[TRIANGLES][3];

/* A tilted sheet of a square's size. */
static void sheet(float *to, float height, float tilt)
{
    int i, j;
    for (i = 0; i <= SIDE; i++)
        for (j = 0; j <= SIDE; j++) {
            float *point = to + 3 * (i * (SIDE + 1) + j);
            point[0] = (float)i / SIDE;
            point[1] = (float)j / SIDE;
            point[2] = height + tilt * point[0];
        }
}

/* A fixed ground, and a sheet that falls through it. */
static NearmissDetector *detector_on(const NearmissDevice *device)
{
    static float ground[NUMBERS];
    NearmissScene *scene;
    NearmissDetector *detector;
    NearmissBody body = nearmiss_body();
    int i, j, k = 0;
    for (i = 0; i < SIDE; i++)
        for (j = 0; j < SIDE; j++) {
            const uint32_t a = (uint32_t)(i * (SIDE + 1) + j), c = a + SIDE + 1;
            const uint32_t first[3] = {a, a + 1, c}, second[3] = {a + 1, c + 1, c};
            memcpy(triangles[k++], first, sizeof first);
            memcpy(triangles[k++], second, sizeof second);
        }
    check(nearmiss_scene_create(&scene, &error));
    sheet(ground, 0, 0);
    body.triangles = triangles[0];
    body.triangle_count = TRIANGLES;
    body.name = "ground";
    body.positions = nearmiss_floats(ground, VERTICES);
    body.kind = NEARMISS_BODY_FIXED;
    check(nearmiss_scene_add(scene, &body, NULL, &error));
    body.name = "sheet";
    body.positions = nearmiss_floats(at[0], VERTICES);
    body.kind = NEARMISS_BODY_DEFORMABLE;
    check(nearmiss_scene_add(scene, &body, NULL, &error));
    check(nearmiss_detector_create(device, scene, &detector, &error));
    nearmiss_scene_free(scene);
    return detector;
}

/* Figures of an answer, which is freed. */
static NearmissSummary summed(NearmissAnswer *answer)
{
    NearmissSummary summary;
    check(nearmiss_answer_summary(answer, &summary, &error));
    nearmiss_answer_free(answer);
    return summary;
}

/* Bytes that a step copies to the device, by the detector's own count. */
static unsigned long long bytes_to_device(NearmissDetector *detector, const NearmissMotion *motion,
                                          const NearmissQuery *query)
{
    const char *text, *mark = "\"to_device\":{";
    unsigned long long sum = 0, bytes;
    NearmissAnswer *answer;
    int i;
    for (i = 0; i < 3; i++) {
        check(nearmiss_detector_step(detector, motion, 1, query, &answer, &error));
        nearmiss_answer_free(answer);
    }
    check(nearmiss_detector_plan(detector, query, &text, &error));
    while ((text = strstr(text, mark)) != NULL && (text = strstr(text, "\"bytes\":")) != NULL)
        if (sscanf(text, "\"bytes\":%llu", &bytes) == 1)
            sum += bytes;
    return sum;
}

int main(void)
{
    Handle context, stream, module, move, graph, recorded = NULL, nodes[1024];
    Address arrays[3];
    unsigned count = NUMBERS;
    void *parameters[4] = {&arrays[0], &arrays[1], &arrays[2], &count};
    unsigned long long from_host, from_device;
    unsigned long found[2] = {0, 0}, differ = 0, again = 0;
    size_t node_count = 0, copies = 0, i;
    int device_number, type, frame, k;
    NearmissDevice *gpu, *cpu;
    NearmissDetector *detector, *judge;
    NearmissAnswer *answer;
    NearmissMotion shared, own;
    NearmissQuery queries[2];

    if (nearmiss_abi() != NEARMISS_ABI) {
        fprintf(stderr, "the header is not that of the library %s\n", nearmiss_version());
        return 1;
    }
    if (!open_driver() || cu.device(&device_number, 0) != 0) {
        printf("no GPU\n");
        return 77;
    }
    sheet(at[0], 0.3f, 0.2f);
    memcpy(at[1], at[0], BYTES);
    for (i = 2; i < NUMBERS; i += 3)
        velocity[i] = -0.0006f;
    cuda(cu.context(&context, 0, device_number), "a context");
    cuda(cu.stream(&stream, 1), "a stream");
    cuda(cu.load(&module, kernel), "the kernel");
    cuda(cu.function(&move, module, "move"), "the kernel");
    for (i = 0; i < 3; i++) {
        cuda(cu.allocate(&arrays[i], BYTES), "memory");
        cuda(cu.up(arrays[i], i < 2 ? at[i] : velocity, BYTES), "a copy");
    }

    check(nearmiss_device_from_stream(context, stream, &gpu, &error));
    check(nearmiss_device_open(NEARMISS_CPU, 0, &cpu, &error));
    detector = detector_on(gpu);
    judge = detector_on(cpu);
    queries[0] = nearmiss_query(NEARMISS_CONTINUOUS);
    queries[0].tolerance = 1e-6;
    queries[1] = nearmiss_query(NEARMISS_NEAR);
    queries[1].distance = 0.002;
    own = nearmiss_motion_step(1, nearmiss_floats(at[0], VERTICES), nearmiss_floats(at[1], VERTICES));
    shared = nearmiss_motion_step(1, nearmiss_floats((const float *)(size_t)arrays[0], VERTICES),
                                  nearmiss_floats((const float *)(size_t)arrays[1], VERTICES));
    shared.on_device = 1;
    from_host = bytes_to_device(detector, &own, queries);
    from_device = bytes_to_device(detector, &shared, queries);

    for (frame = 0; frame < FRAMES; frame++) {
        NearmissSummary own_figures, wanted;
        bool prepared;
        check(nearmiss_detector_is_prepared(detector, &prepared, &error));
        if (!prepared) {
            check(nearmiss_detector_prepare(detector, &shared, 1, queries, 2, &error));
            cuda(cu.begin(stream, 0), "recording");
            cuda(cu.launch(move, (NUMBERS + 255) / 256, 1, 1, 256, 1, 1, 0, stream, parameters, NULL), "the kernel");
            check(nearmiss_detector_submit(detector, &error));
            cuda(cu.end(stream, &graph), "the graph");
            cuda(cu.instantiate(&recorded, graph, 0), "the graph");
            node_count = sizeof nodes / sizeof *nodes;
            cuda(cu.nodes(graph, nodes, &node_count), "its nodes");
            for (copies = i = 0; i < node_count; i++) {
                cuda(cu.type(nodes[i], &type), "a node");
                copies += type == 1;
            }
            again++;
        }
        cuda(cu.replay(recorded, stream), "the graph's launch");
        memcpy(at[0], at[1], BYTES);
        for (i = 0; i < NUMBERS; i++)
            at[1][i] += velocity[i];
        check(nearmiss_detector_update(judge, &own, 1, &error));
        for (k = 0; k < 2; k++) {
            check(nearmiss_detector_collect(detector, &queries[k], &answer, &error));
            own_figures = summed(answer);
            check(nearmiss_detector_query(judge, &queries[k], &answer, &error));
            wanted = summed(answer);
            differ += own_figures.hash != wanted.hash || own_figures.contacts != wanted.contacts;
            found[k] += (unsigned long)own_figures.contacts;
        }
    }
    printf("%d launches of a graph of %u nodes, %u of them copies, recorded %lu times\n", FRAMES, (unsigned)node_count,
           (unsigned)copies, again);
    printf("%lu contacts and %lu near pairs; %lu answers differ from the CPU's\n", found[0], found[1], differ);
    printf("bytes copied to the device in a step: %llu from the host, %llu from the device\n", from_host, from_device);
    nearmiss_detector_free(detector);
    nearmiss_detector_free(judge);
    nearmiss_device_free(gpu);
    nearmiss_device_free(cpu);
    return differ != 0 || found[0] < 1000 || found[1] < 1000 || from_host < 2 * BYTES || from_device >= 1000;
}
