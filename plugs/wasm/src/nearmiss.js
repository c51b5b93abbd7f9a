// The program nearmiss as a function: arguments and files in, text and files out.

import { Directory, Fd, File, PreopenDirectory, WASI, wasi } from "@bjorn3/browser_wasi_shim";

/** Standard input without a byte. */
class Nothing extends Fd {
  fd_read() {
    return { ret: wasi.ERRNO_SUCCESS, data: new Uint8Array() };
  }
}

/** Standard output or standard error: its bytes and its text are kept, and its text is passed on. */
class Output extends Fd {
  constructor(printed = () => {}) {
    super();
    Object.assign(this, { printed, parts: [], text: "", decoder: new TextDecoder() });
  }

  fd_write(bytes) {
    this.parts.push(bytes.slice());
    const text = this.decoder.decode(bytes, { stream: true });
    this.text += text;
    this.printed(text);
    return { ret: wasi.ERRNO_SUCCESS, nwritten: bytes.length };
  }

  async bytes() {
    return new Uint8Array(await new Blob(this.parts).arrayBuffer());
  }
}

/** The folder of one run. Names may have folders: `shot/cloth.1001.ply`. */
function folder(files) {
  const root = new Directory(new Map());
  for (const [name, bytes] of Object.entries(files)) {
    const path = name.split("/");
    if (path.some((part) => ["", ".", ".."].includes(part))) {
      throw new Error(`files must have relative names without . and .., got ${name}`);
    }
    let at = root;
    for (const part of path.slice(0, -1)) {
      if (!at.contents.has(part)) {
        at.contents.set(part, new Directory(new Map()));
      }
      at = at.contents.get(part);
      if (!(at instanceof Directory)) {
        throw new Error(`${part} is a file and a folder in ${name}; rename one`);
      }
    }
    const last = path.at(-1);
    if (at.contents.has(last)) {
      throw new Error(`${last} is a file and a folder in ${name}; rename one`);
    }
    at.contents.set(last, new File(bytes));
  }
  return root;
}

/** All files below a folder, by name. */
function* below(root, prefix = "") {
  for (const [name, entry] of root.contents) {
    if (entry instanceof Directory) {
      yield* below(entry, `${prefix}${name}/`);
    } else {
      yield [prefix + name, entry];
    }
  }
}

/**
 * Runs the program once, in this thread: a page calls it in a worker.
 *
 * @param {WebAssembly.Module} program nearmiss.wasm, compiled
 * @param {string[]} args arguments as on a command line: `["detect", "cloth.ply", "--json"]`
 * @param {Object<string, Uint8Array>} files the files that the program sees, by name
 * @param {{out?: (text: string) => void, err?: (text: string) => void}} printed called with text
 *   as soon as it is printed
 * @returns {Promise<{status: number, stdout: Uint8Array, out: string, err: string,
 *   files: Object<string, Uint8Array>}>} exit status, standard output as bytes and as text,
 *   standard error, and the files that the program has written
 * @throws {Error} if a name is not one of a file, or the program ends without a status, for
 *   example because 4 GiB of memory are too few. The message has what it has printed.
 */
export async function run(program, args, files = {}, printed = {}) {
  const root = folder(files);
  const given = new Map([...below(root)].map(([name, file]) => [name, [file, file.data]]));
  const [out, err] = [printed.out, printed.err].map((print) => new Output(print));
  const here = new PreopenDirectory(".", root.contents);
  const host = new WASI(["nearmiss", ...args], [], [new Nothing(), out, err, here], {
    debug: false,
  });
  const instance = await WebAssembly.instantiate(program, {
    wasi_snapshot_preview1: host.wasiImport,
  });
  let status;
  try {
    status = host.start(instance);
  } catch (cause) {
    const said = err.text.trim();
    throw new Error(`nearmiss has ended early: ${cause.message}${said && `; ${said}`}`, { cause });
  }
  const isNew = ([name, file]) => {
    const [before, data] = given.get(name) ?? [];
    return file !== before || file.data !== data;
  };
  const written = [...below(root)].filter(isNew).map(([name, file]) => [name, file.data]);
  return {
    status,
    stdout: await out.bytes(),
    out: out.text,
    err: err.text,
    files: Object.fromEntries(written),
  };
}
