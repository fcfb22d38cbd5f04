// A headless Chromium for the tests of pages. Exit 77 where there is none: nothing tested.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const skipped = 77;

function skip(why) {
  console.log(`SKIPPED: ${why}; tools/setup --tests installs it`);
  process.exit(skipped);
}

const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser"].find(existsSync) ?? skip("no Chromium");
const { chromium: browserType } = await import("playwright-core").catch(() => skip("no playwright-core"));

/** To be evaluated in a page: until the next frame has been drawn. */
export const frame = "new Promise((done) => requestAnimationFrame(() => setTimeout(done)))";

/** How many of a plot's pixels bear a colour: neither background, nor grid, nor text. */
export const colouredPixels = (page, selector) => page.$eval(selector, (canvas) => {
  const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) {
    const [r, g, b, alpha] = data.subarray(i, i + 4);
    if (alpha > 100 && Math.max(r, g, b) - Math.min(r, g, b) > 60) count += 1;
  }
  return count;
});

/** Calls `use` with a function that opens an empty page. */
export async function withBrowser(use) {
  const profile = mkdtempSync(join(tmpdir(), "lineshaft-browser-"));
  const context = await browserType.launchPersistentContext(profile, {
    executablePath: chromium,
    headless: true,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
           "--disable-background-networking", "--disable-component-update", "--disable-sync"],
  });
  try {
    await use(async ({ viewport, colorScheme }) => {
      const page = await context.newPage();
      await page.setViewportSize(viewport);
      await page.emulateMedia({ colorScheme });
      return page;
    });
  } finally {
    await context.close();
    rmSync(profile, { recursive: true, force: true });
  }
}
