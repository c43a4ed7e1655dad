'use strict';
class Live { start() {} }
