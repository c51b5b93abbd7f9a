//! The simulator, by raw calls of the driver.

use bytemuck::Pod;
use cudarc::driver::sys::{self, CUresult};
use std::ffi::{CString, c_void};
use std::ptr::null_mut;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// While it is held no other test of this program drives a simulator. Nothing else may wait for the
/// device while one records, and times of two at once belong to neither.
pub fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Its kernel: where a vertex was at the end of the last step it is at the start of this one, and it moves on.
const STEP: &str = "
.version 7.5
.target sm_80
.address_size 64
.visible .entry step(.param .u64 t0, .param .u64 t1, .param .u64 velocity, .param .u32 count)
{
    .reg .u32 %r<6>;
    .reg .u64 %d<8>;
    .reg .f32 %f<4>;
    .reg .pred %p;
    mov.u32 %r0, %ctaid.x;
    mov.u32 %r1, %ntid.x;
    mov.u32 %r2, %tid.x;
    mad.lo.u32 %r3, %r0, %r1, %r2;
    ld.param.u32 %r4, [count];
    setp.ge.u32 %p, %r3, %r4;
    @%p bra done;
    ld.param.u64 %d0, [t0];
    ld.param.u64 %d1, [t1];
    ld.param.u64 %d2, [velocity];
    mul.wide.u32 %d3, %r3, 4;
    add.u64 %d4, %d0, %d3;
    add.u64 %d5, %d1, %d3;
    add.u64 %d6, %d2, %d3;
    ld.global.f32 %f0, [%d5];
    ld.global.f32 %f1, [%d6];
    st.global.f32 [%d4], %f0;
    add.rn.f32 %f2, %f0, %f1;
    st.global.f32 [%d5], %f2;
done:
    ret;
}
";

/// A context, a stream and memory of its own.
pub struct Simulator {
    context: sys::CUcontext,
    stream: sys::CUstream,
    step: sys::CUfunction,
    arrays: [sys::CUdeviceptr; 3],
    count: usize,
}

/// A recorded frame.
pub struct Graph(sys::CUgraphExec);

fn ok(result: CUresult) {
    assert_eq!(result, CUresult::CUDA_SUCCESS);
}

impl Simulator {
    /// Both ends of the step at `start`, and how each number moves a frame.
    pub fn new(start: &[f32], velocity: &[f32]) -> Simulator {
        let (mut context, mut stream, mut module, mut step) =
            (null_mut(), null_mut(), null_mut(), null_mut());
        let mut arrays = [0; 3];
        let bytes = size_of_val(start);
        let text = CString::new(STEP).expect("no zero");
        // SAFETY: the driver's calls in the order that it requires, with our own memory to write
        // to.
        unsafe {
            let mut device = 0;
            ok(sys::cuInit(0));
            ok(sys::cuDeviceGet(&mut device, 0));
            ok(sys::cuCtxCreate_v2(&mut context, 0, device));
            ok(sys::cuStreamCreate(&mut stream, sys::CUstream_flags::CU_STREAM_NON_BLOCKING as u32));
            ok(sys::cuModuleLoadData(&mut module, text.as_ptr().cast()));
            ok(sys::cuModuleGetFunction(&mut step, module, c"step".as_ptr()));
            for array in &mut arrays {
                ok(sys::cuMemAlloc_v2(array, bytes));
            }
            ok(sys::cuMemcpyHtoD_v2(arrays[2], velocity.as_ptr().cast(), bytes));
        }
        let simulator = Simulator { context, stream, step, arrays, count: start.len() };
        simulator.write(start, start);
        simulator
    }

    /// Sets both ends of the step.
    pub fn write(&self, t0: &[f32], t1: &[f32]) {
        assert!(t0.len() == self.count && t1.len() == self.count);
        for (array, numbers) in self.arrays.iter().zip([t0, t1]) {
            // SAFETY: so many numbers are there.
            ok(unsafe { sys::cuMemcpyHtoD_v2(*array, numbers.as_ptr().cast(), size_of_val(numbers)) });
        }
    }

    pub fn context(&self) -> *mut c_void {
        self.context.cast()
    }

    pub fn stream(&self) -> *mut c_void {
        self.stream.cast()
    }

    /// Addresses of the vertices, at both ends of the step.
    pub fn positions(&self) -> [u64; 2] {
        [self.arrays[0], self.arrays[1]]
    }

    /// Starts its kernel.
    pub fn step(&self) {
        let [mut t0, mut t1, mut velocity] = self.arrays;
        let mut count = self.count as u32;
        let mut parameters = [
            (&raw mut t0).cast(),
            (&raw mut t1).cast(),
            (&raw mut velocity).cast(),
            (&raw mut count).cast::<c_void>(),
        ];
        // SAFETY: the kernel's four parameters, of their types; the arrays have so many numbers.
        ok(unsafe {
            let blocks = count.div_ceil(256);
            let none = null_mut();
            sys::cuLaunchKernel(
                self.step,
                blocks,
                1,
                1,
                256,
                1,
                1,
                0,
                self.stream,
                parameters.as_mut_ptr(),
                none,
            )
        });
    }

    /// Records what is put into the stream, under the strictest rules that the driver has.
    pub fn record(&self, work: impl FnOnce()) -> Graph {
        let (mut graph, mut exec) = (null_mut(), null_mut());
        let mode = sys::CUstreamCaptureMode::CU_STREAM_CAPTURE_MODE_GLOBAL;
        // SAFETY: the stream is ours, and the driver writes two handles.
        unsafe {
            ok(sys::cuCtxSetCurrent(self.context));
            ok(sys::cuStreamBeginCapture_v2(self.stream, mode));
            work();
            ok(sys::cuStreamEndCapture(self.stream, &mut graph));
            ok(sys::cuGraphInstantiateWithFlags(&mut exec, graph, 0));
        }
        Graph(exec)
    }

    /// Launches what was recorded, and waits.
    pub fn launch(&self, graph: &Graph) {
        // SAFETY: both are ours.
        ok(unsafe { sys::cuGraphLaunch(graph.0, self.stream) });
        self.wait();
    }

    /// Waits for the stream.
    pub fn wait(&self) {
        // SAFETY: it is ours.
        ok(unsafe { sys::cuStreamSynchronize(self.stream) });
    }

    /// Numbers at an address of the device.
    pub fn read<T: Pod>(&self, address: u64, count: usize) -> Vec<T> {
        let mut all = vec![T::zeroed(); count];
        if count > 0 {
            // SAFETY: who gave the address has said that they are there.
            ok(unsafe { sys::cuMemcpyDtoH_v2(all.as_mut_ptr().cast(), address, count * size_of::<T>()) });
        }
        all
    }
}
