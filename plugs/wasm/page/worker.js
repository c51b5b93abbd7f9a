// One run of the program, beside the page.

import { run } from "../src/nearmiss.js";

self.onmessage = async ({ data: { program, args, files } }) => {
  const pass = (text) => self.postMessage({ text });
  try {
    const { status, files: written } = await run(program, args, files, { out: pass, err: pass });
    self.postMessage({ status, written });
  } catch (error) {
    self.postMessage({ text: `${error.message}\n`, status: null, written: {} });
  }
};
