// A headless Chromium, steered as a person would: keys, clicks, reloads, downloads. Speaks the browser's
// DevTools protocol over a pipe and needs no package.
import {spawn} from 'node:child_process';
import {mkdtemp, rm, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';

const kPatience_ms = 60000;
const kKeys = {
  Enter: {code: 'Enter', text: '\r', windowsVirtualKeyCode: 13},
  Tab: {code: 'Tab', windowsVirtualKeyCode: 9},
  ArrowRight: {code: 'ArrowRight', windowsVirtualKeyCode: 39},
  r: {code: 'KeyR', text: 'r', windowsVirtualKeyCode: 82},
};

export const pause = ms => new Promise(done => setTimeout(done, ms));

export class Browser {
  /// `downloads`: the folder where they go. Throws when the browser does not start.
  static async start(program, downloads) {
    const browser = new Browser();
    browser.profile = await mkdtemp(join(tmpdir(), 'understudy-browser-'));
    browser.process = spawn(program, [
      '--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking',
      '--disable-component-update', '--disable-sync', '--disable-extensions', '--disable-dev-shm-usage',
      '--disable-gpu', '--remote-debugging-pipe', `--user-data-dir=${browser.profile}`,
    ], {stdio: ['ignore', 'ignore', 'pipe', 'pipe', 'pipe'], detached: true});
    browser.listen(program);
    await browser.send('Browser.setDownloadBehavior', {behavior: 'allow', downloadPath: downloads});
    return browser;
  }
  constructor() {
    this.waiting = new Map();
    this.pages = new Map();
    this.count = 0;
  }
  listen(program) {
    let complaints = '', text = '';
    const fail = why => {
      for (const {failed} of this.waiting.values()) failed(new Error(why));
      this.waiting.clear();
    };
    this.process.stderr.on('data', some => { complaints = (complaints + some).slice(-2000); });
    this.process.on('error', error => fail(`${program}: ${error.message}`));
    this.process.on('exit', code => fail(`the browser ended with ${code}: ${complaints}`));
    this.process.stdio[3].on('error', () => {});  // its end is told by 'exit'
    this.process.stdio[4].on('data', some => {
      const messages = (text + some).split('\0');
      text = messages.pop();
      for (const message of messages) this.take(JSON.parse(message));
    });
  }
  take(message) {
    if (message.method === 'Page.javascriptDialogOpening')
      this.send('Page.handleJavaScriptDialog', {accept: true}, message.sessionId);
    const page = this.pages.get(message.sessionId);
    if (page && message.method === 'Runtime.exceptionThrown') {
      const {exception, text, url, lineNumber} = message.params.exceptionDetails;
      page.errors.push(`${url}:${lineNumber + 1}: ${exception?.description ?? exception?.value ?? text}`);
    }
    const {done, failed} = this.waiting.get(message.id) ?? {};
    this.waiting.delete(message.id);
    if (message.error) failed?.(new Error(message.error.message));
    else done?.(message.result);
  }
  send(method, params = {}, sessionId = undefined) {
    return new Promise((done, failed) => {
      const id = ++this.count;
      this.waiting.set(id, {done, failed});
      this.process.stdio[3].write(JSON.stringify({id, method, params, sessionId}) + '\0');
    });
  }
  async open(address, size = [1280, 720]) {
    const {targetId} = await this.send('Target.createTarget', {url: 'about:blank'});
    const {sessionId} = await this.send('Target.attachToTarget', {targetId, flatten: true});
    const page = new Page(this, targetId, sessionId);
    this.pages.set(sessionId, page);
    await page.send('Page.enable');
    await page.send('Runtime.enable');
    await page.resize(...size);
    await page.go(address);
    return page;
  }
  async close() {
    const ended = new Promise(done => this.process.on('exit', done));
    try {
      process.kill(-this.process.pid, 'SIGKILL');
      await ended;
    } catch {
      // it is gone already
    }
    await rm(this.profile, {recursive: true, force: true, maxRetries: 10, retryDelay: 100});
  }
}

class Page {
  constructor(browser, target, session) {
    this.browser = browser;
    this.target = target;
    this.session = session;
    this.errors = [];
  }
  send(method, params = {}) {
    return this.browser.send(method, params, this.session);
  }
  async go(address) {
    await this.send('Page.navigate', {url: address});
    await this.until('document.readyState === "complete"');
  }
  resize(width, height) {
    return this.send('Emulation.setDeviceMetricsOverride',
                     {width, height, deviceScaleFactor: 1, mobile: false});
  }
  async reload() {
    await this.evaluate('window.isOld = true');
    await this.send('Page.reload');
    await this.until('!window.isOld && document.readyState === "complete"');
  }
  async evaluate(expression) {
    const {result, exceptionDetails} =
        await this.send('Runtime.evaluate', {expression, returnByValue: true, awaitPromise: true});
    if (exceptionDetails) throw new Error(`${expression}: ${exceptionDetails.exception?.description}`);
    return result.value;
  }
  /// Waits until the expression is true; throws with what the page shows.
  async until(expression) {
    const began = Date.now();
    for (;;) {
      try {
        if (await this.evaluate(expression)) return;
      } catch (error) {
        if (!/context|navigated/i.test(error.message)) throw error;  // the page is being changed
      }
      if (Date.now() - began > kPatience_ms)
        throw new Error(`never came: ${expression}; there is: ${await this.text()} ${this.errors}`);
      await pause(20);
    }
  }
  text() {
    return this.evaluate('document.body?.innerText');
  }
  says(text) {
    return this.until(`document.body?.innerText.includes(${JSON.stringify(text)})`);
  }
  async press(key) {
    const known = kKeys[key] ?? {code: `Digit${key}`, text: key, windowsVirtualKeyCode: key.charCodeAt(0)};
    await this.send('Input.dispatchKeyEvent', {type: 'keyDown', key, ...known});
    await this.send('Input.dispatchKeyEvent', {type: 'keyUp', key, ...known, text: undefined});
  }
  type(text) {
    return this.send('Input.insertText', {text});
  }
  /// Clicks into the middle of what the expression gives. Throws when something else lies over it.
  async click(expression) {
    const [x, y, is_seen] = await this.evaluate(`(() => {
      const one = ${expression};
      one.scrollIntoView({block: 'nearest'});
      const box = one.getBoundingClientRect(), x = box.x + box.width / 2, y = box.y + box.height / 2;
      const seen = document.elementFromPoint(x, y);
      return [x, y, one.contains(seen) || Boolean(seen?.contains(one))];
    })()`);
    if (!is_seen) throw new Error(`${expression} cannot be clicked; there is: ${await this.text()}`);
    const event = {x, y, button: 'left', clickCount: 1};
    await this.send('Input.dispatchMouseEvent', {type: 'mousePressed', ...event});
    await this.send('Input.dispatchMouseEvent', {type: 'mouseReleased', ...event});
  }
  click_button(text) {
    const wanted = JSON.stringify(text);
    return this.click(`[...document.querySelectorAll('button')].find(one => !one.hidden && one.offsetParent &&
                       one.innerText.startsWith(${wanted}))`);
  }
  /// As .png or .webp.
  async screenshot(path) {
    const kind = path.endsWith('.webp') ? {format: 'webp', quality: 80} : {format: 'png'};
    const {data} = await this.send('Page.captureScreenshot', kind);
    await writeFile(path, Buffer.from(data, 'base64'));
  }
  close() {
    this.browser.pages.delete(this.session);
    return this.browser.send('Target.closeTarget', {targetId: this.target});
  }
}
