// node smaller.mjs CHROMIUM WIDTH PICTURE.png...: puts a .webp of this width in each one's place.
import {readFile, rm, stat} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {Browser} from '../tests/interop/browser/chromium.mjs';

const [chromium, width, ...pictures] = process.argv.slice(2);
const browser = await Browser.start(chromium, tmpdir());
try {
  for (const picture of pictures) {
    const page = await browser.open('about:blank', [Number(width), 100]);
    const bytes = (await readFile(picture)).toString('base64');
    const height = await page.evaluate(`(async () => {
      document.body.style.cssText = 'margin: 0; overflow: hidden';
      const image = new Image();
      image.style.cssText = 'display: block; width: ${width}px';
      image.src = 'data:image/png;base64,${bytes}';
      await image.decode();
      document.body.append(image);
      return Math.round(image.getBoundingClientRect().height);
    })()`);
    await page.resize(Number(width), height);
    const smaller = picture.replace(/\.png$/, '.webp');
    await page.screenshot(smaller);
    await page.close();
    await rm(picture);
    console.log(`${smaller}: ${Math.ceil((await stat(smaller)).size / 1000)} kB`);
  }
} finally {
  await browser.close();
}
