// A page that runs the program in the browser on files that are dropped on it.

/** The name of the page that `view` writes, and of the scene of several bodies. */
const VIEW = "view.html";
const SCENE = "scene.toml";
/** A scene that the program makes itself. */
const EXAMPLE = ["--scene", "draped", "--triangles", "2000"];

const by = (id) => document.getElementById(id);

/** nearmiss.wasm of this page, compiled. It is compressed, in base64. */
async function compiled() {
  const packed = Uint8Array.from(atob(by("program").textContent), (letter) =>
    letter.charCodeAt(0),
  );
  const unpacked = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return WebAssembly.compile(await new Response(unpacked).arrayBuffer());
}

/** Words of a line: separated by spaces, except in quotes. */
function words(line) {
  const found = line.match(/(?:"[^"]*"|'[^']*'|[^\s"'])+/g) ?? [];
  return found.map((word) => word.replace(/"([^"]*)"|'([^']*)'/g, "$1$2"));
}

/** A scene file of bodies that may all meet. */
function sceneOf(names) {
  return names.map((name) => `[[body]]\nmesh = ${JSON.stringify(name)}\n`).join("\n");
}

class Try {
  constructor() {
    this.files = new Map();
    this.program = compiled();
    this.program.catch((error) => {
      by("note").textContent = `The program does not start: ${error.message}`;
    });
    this.worker = URL.createObjectURL(
      new Blob([by("worker").textContent], { type: "text/javascript" }),
    );
    this.urls = [];
    by("choose").onchange = () => this.take(by("choose").files);
    by("example").onclick = () => this.run(EXAMPLE);
    by("run").onclick = () => this.run();
    by("stop").onclick = () => this.end("stopped\n");
    by("options").onkeydown = ({ key }) => key === "Enter" && !by("run").disabled && this.run();
    document.ondragover = (event) => this.over(event, true);
    document.ondragleave = (event) => this.over(event, false);
    document.ondrop = (event) => {
      this.over(event, false);
      this.take(event.dataTransfer.files);
    };
    this.show();
  }

  over(event, on) {
    event.preventDefault();
    document.body.classList.toggle("over", on);
  }

  /** Takes files, and runs the program on all. */
  async take(list) {
    // The list empties with the element that it is of.
    const files = [...list];
    by("choose").value = "";
    for (const file of files) {
      this.files.set(file.name, new Uint8Array(await file.arrayBuffer()));
    }
    this.show();
    if (files.length > 0) {
      this.run();
    }
  }

  /** Names of all files: frames in the order of their numbers. */
  names() {
    const order = new Intl.Collator("en", { numeric: true }).compare;
    return [...this.files.keys()].sort(order);
  }

  show() {
    const line = (name) => {
      const item = document.createElement("li");
      const away = Object.assign(document.createElement("button"), { textContent: "×" });
      away.title = `leave out ${name}`;
      away.onclick = () => {
        this.files.delete(name);
        this.show();
      };
      item.append(name, away);
      return item;
    };
    by("files").replaceChildren(...this.names().map(line));
    by("as").hidden = this.files.size < 2;
    by("run").disabled = this.files.size === 0;
  }

  say(text) {
    by("text").append(text);
    by("text").scrollTop = by("text").scrollHeight;
  }

  /** Arguments of the run: of a built-in scene, or of the files of the list. */
  question(scene) {
    const files = Object.fromEntries(this.files);
    let meshes = scene ?? this.names();
    if (!scene && meshes.length > 1 && by("as").value === "bodies") {
      files[SCENE] = new TextEncoder().encode(sceneOf(meshes));
      meshes = [SCENE];
    }
    const command = scene ? "view" : by("command").value;
    const out = command === "view" ? ["--out", VIEW] : [];
    return { args: [command, ...meshes, ...out, ...words(by("options").value)], files };
  }

  /** Runs the program; the last run ends. */
  async run(scene) {
    this.end("");
    document.body.classList.remove("empty");
    by("text").textContent = "";
    by("written").replaceChildren();
    by("result").hidden = true;
    this.urls.forEach((url) => URL.revokeObjectURL(url));
    this.urls = [];
    const { args, files } = this.question(scene);
    this.say(`$ nearmiss ${args.join(" ")}\n`);
    by("stop").disabled = false;
    const worker = new Worker(this.worker);
    this.running = worker;
    worker.onmessage = ({ data }) => {
      if (data.text !== undefined) {
        this.say(data.text);
      }
      if (data.status !== undefined) {
        this.done(data);
      }
    };
    worker.onerror = ({ message }) => this.end(`The program has ended early: ${message}\n`);
    // Without a program its fault is shown.
    const program = await this.program.catch(() => undefined);
    // Another run may have begun meanwhile.
    if (this.running !== worker) {
      return;
    }
    if (program) {
      worker.postMessage({ program, args, files });
    } else {
      this.end("");
    }
  }

  /** Ends the run, if there is one. */
  end(text) {
    this.running?.terminate();
    this.running = undefined;
    by("stop").disabled = true;
    this.say(text);
  }

  /** Shows what a run has written. */
  done({ status, written }) {
    this.end(status ? `exit status ${status}\n` : "");
    for (const [name, bytes] of Object.entries(written)) {
      const type = name.endsWith(".html") ? "text/html" : "application/octet-stream";
      const url = URL.createObjectURL(new Blob([bytes], { type }));
      this.urls.push(url);
      by("written").append(
        Object.assign(document.createElement("a"), { href: url, download: name, textContent: `save ${name}` }),
      );
      if (name === VIEW) {
        by("result").src = url;
        by("result").hidden = false;
      }
    }
  }
}

new Try();
